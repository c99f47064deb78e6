#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <spherical_actuator_calibration/CheckCoils.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/motion/motion_memory.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"
#include "spherical_actuator_calibration/ros/conversion/measurement_reader.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"
#include "spherical_actuator_calibration/streams/arrival_watch.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "spherical_actuator_calibration/streams/stream_merger.hpp"

namespace sac {

/// Receives the four streams of measurements (joint_states, measured_orientation, measured_torque,
/// coil_currents) in a thread of its own, so that nothing else delays them, and makes samples of
/// them, and answers `check_coils` of its node there. For motions it hears coil_setpoints, or
/// without them coil_command, as well. Of a rotor without joints there are three: joint_states are
/// not waited for, and no motion is kept. All member functions may be called from any thread.
class MeasurementIntake {
 public:
  /// Subscribes below the namespace of `node`, and receives from then on.
  MeasurementIntake(const ros::NodeHandle& node,
                    const Actuator& nominal,
                    const CalibrationConfig& config);
  ~MeasurementIntake();
  MeasurementIntake(const MeasurementIntake&) = delete;
  MeasurementIntake& operator=(const MeasurementIntake&) = delete;

  /// Samples of the dwells that have ended since the last call. When nothing came for a while (a
  /// recording is over, its clock stands still) what is there is evaluated as if the streams had
  /// ended; measurements may go on afterwards.
  std::vector<Sample> takeSamples();

  /// Waits until the measurements from now on make a sample of this duration [s], or it is known
  /// why they do not: see SampleBuilder::capture(). Never kWaiting.
  CaptureProgress waitForCapture(double duration) const;

  /// Currents that were measured last [A], one per coil; none where none came for a second.
  Eigen::VectorXd currents() const;

  /// How the rotor moved with currents lately: see MotionMemory.
  MotionRecording motion();
  /// Windows of motion since the last call: see MotionSlicer.
  std::vector<MotionSlice> takeWindows();
  void forgetMotion();
  /// Takes up the motion of an earlier intake: see MotionMemory.
  void restoreMotion(const std::vector<MotionSlice>& windows);

  /// Adds one diagnostic task per stream, and one for the dwells.
  void addDiagnostics(NodeDiagnostics& diagnostics);

 private:
  template <typename Message>
  void subscribe(StreamMonitor& monitor);
  void subscribeCommands();
  /// `take`: a message, while mutex_ is held.
  void subscribeCommands(const char* topic,
                         const std::function<void(const CurrentCommand& command)>& take);
  void merge(AnyMeasurement measurement);
  // Precondition of these: mutex_ is held.
  bool haveStreamsEnded();
  void finish();
  void buildInOrder();
  void build(const AnyMeasurement& measurement);
  /// Keeps what tells how the rotor moves.
  template <typename Measurement>
  void follow(const Measurement& measurement);
  template <typename Measurement>
  void build(const Measurement& measurement,
             const StreamStatistics& statistics,
             StreamMonitor& monitor);

  /// In the receiving thread: however long other services take, it answers.
  bool checkCoils(msg::CheckCoils::Request& request, msg::CheckCoils::Response& response);

  /// Whether there is one for each coil, and all are finite.
  bool isOfCoils(const Eigen::VectorXd& currents) const;
  void keepNewest(const Eigen::VectorXd& currents);
  CaptureProgress capture(Stamp from, double duration) const;
  std::optional<Stamp> newest() const;
  void diagnoseDwells(DiagnosticStatus& status);

  const bool has_joints_;
  const std::size_t coils_;
  const double current_threshold_;  ///< [A]
  std::atomic<std::uint64_t> received_{0};

  mutable std::mutex mutex_;  ///< of all down to finished_
  StreamMerger merger_;
  SampleBuilder builder_;
  Eigen::VectorXd newest_currents_;
  double currents_arrived_ = -1e9;   ///< when these came, by a clock that never jumps [s]
  double setpoints_arrived_ = -1e9;  ///< by the same clock [s]
  MotionMemory motion_;
  MotionSlicer slicer_;
  ArrivalWatch arrivals_{0, 0.0};  ///< by the calls of takeSamples()
  bool finished_ = true;           ///< nothing came since finish()

  // Used by the receiving thread alone, or thread-safe by themselves.
  MeasurementReader reader_;
  StreamMonitor joints_;
  StreamMonitor orientations_;
  StreamMonitor torques_;
  StreamMonitor currents_;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::ServiceServer coil_check_;
  ros::AsyncSpinner receiver_;
};

}  // namespace sac
