#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"
#include "spherical_actuator_calibration/streams/stream_merger.hpp"

namespace sac {

/// Receives the four streams of measurements (joint_states, measured_orientation, measured_torque,
/// coil_currents) in a thread of its own, so that nothing else delays them, and makes samples of
/// them. All member functions may be called from any thread.
class MeasurementIntake {
 public:
  /// Subscribes below the namespace of `node`, and receives from then on.
  MeasurementIntake(const ros::NodeHandle& node,
                    const Actuator& nominal,
                    const CalibrationConfig& config);
  ~MeasurementIntake();
  MeasurementIntake(const MeasurementIntake&) = delete;
  MeasurementIntake& operator=(const MeasurementIntake&) = delete;

  /// Samples of the dwells that have ended since the last call.
  std::vector<Sample> takeSamples();

  /// See SampleBuilder::capture().
  CaptureProgress capture(Stamp from, double duration) const;

  /// Newest stamp of all streams.
  std::optional<Stamp> newest() const;
  /// Measurements received so far, of all streams: tells whether any still come.
  std::uint64_t received() const { return received_; }

  /// Evaluates what is there as if the streams had ended: nothing came for a while (a recording is
  /// over, its clock stands still). Measurements may go on afterwards.
  void finish();

  /// Adds one diagnostic task per stream, and one for the dwells.
  void addDiagnostics(diagnostic_updater::Updater& updater);

 private:
  void receive(const sensor_msgs::JointState::ConstPtr& message);
  void receive(const geometry_msgs::QuaternionStamped::ConstPtr& message);
  void receive(const geometry_msgs::Vector3Stamped::ConstPtr& message);
  void receive(const msg::CoilCurrents::ConstPtr& message);
  void merge(AnyMeasurement measurement);
  void buildInOrder();
  void build(const AnyMeasurement& measurement);
  template <typename Measurement>
  void build(const Measurement& measurement,
             const StreamStatistics& statistics,
             StreamMonitor& monitor);
  void diagnoseDwells(diagnostic_updater::DiagnosticStatusWrapper& status);

  const MeasurementFrames frames_;
  std::atomic<std::uint64_t> received_{0};

  mutable std::mutex mutex_;  ///< of merger and builder
  StreamMerger merger_;
  SampleBuilder builder_;

  // Used by the receiving thread alone, or thread-safe by themselves.
  JointStateReader joint_reader_;
  StreamMonitor joints_;
  StreamMonitor orientations_;
  StreamMonitor torques_;
  StreamMonitor currents_;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::AsyncSpinner receiver_;
};

}  // namespace sac
