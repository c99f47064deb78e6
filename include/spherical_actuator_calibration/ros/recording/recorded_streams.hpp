#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"
#include "spherical_actuator_calibration/ros/conversion/measurement_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_report.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"

namespace sac {

/// Makes samples of the raw streams of one actuator. Messages without its joints or in another
/// frame are dropped and counted; what else may be wrong with them is the SampleBuilder's to judge.
class RecordedStreams {
 public:
  RecordedStreams(const Actuator& nominal,
                  const MeasurementFrames& frames,
                  const SampleBuilderOptions& options);

  /// Whether what follows is kept for takeMotion(); it is not from the start.
  void keepMotion(bool keep) { keeps_motion_ = keep; }

  /// Whether samples are made of what follows; they are from the start.
  void keepSamples(bool keep) { keeps_samples_ = keep; }

  /// Samples are made of the stretches of these until finish() (SampleBuilder::repeat()).
  void repeat(const std::vector<Sample>& taken) { builder_.repeat(taken); }

  void add(const sensor_msgs::JointState& message);
  void add(const geometry_msgs::QuaternionStamped& message);
  void add(const geometry_msgs::Vector3Stamped& message);
  void add(const msg::CoilCurrents& message);
  /// What was commanded, which need not be recorded.
  void addCommand(const msg::CoilCurrents& message);

  /// No more messages of this base of time follow.
  void finish() {
    builder_.finish();
    motion_.finish();
  }
  std::vector<Sample> takeSamples() { return builder_.takeSamples(); }
  /// The streams themselves, of all bases of time.
  MotionRecording takeMotion() { return motion_.take(); }

  /// True when any message came.
  bool any() const;
  RecordedStreamsReport report() const;

  /// Throws DataError, naming `files`, when all messages of a stream are of another actuator or in
  /// another frame: no joint of the description, no current pattern of its number of coils.
  void requireUsable(const std::string& files) const;

  /// What samples of dwells lack, one sentence each.
  std::vector<std::string> missing() const;

 private:
  const Actuator& nominal_;
  const MeasurementFrames& frames_;
  MeasurementReader reader_;
  SampleBuilder builder_;
  MotionRecorder motion_;
  bool keeps_motion_ = false;
  bool keeps_samples_ = true;

  template <typename Measurement>
  void take(const Measurement& measurement);

  RecordedStreamsReport counts_;  ///< without `samples`
  // The last ones of their kind, for messages.
  std::vector<std::string> other_joints_;
  std::string other_orientation_frame_;
  std::string other_torque_frame_;
  std::size_t currents_ = 0;
};

/// "a.bag: samples have 3 currents, but …": sentence for a recording of another number of coils.
std::string coilMismatch(const std::string& files,
                         const std::string& what,
                         std::size_t recorded,
                         std::size_t described);

}  // namespace sac
