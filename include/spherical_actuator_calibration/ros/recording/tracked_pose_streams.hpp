#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/JointState.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/frame_registration.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/streams/sample_builder.hpp"

namespace sac {

/// Makes poses of the topics joint_states and tracker/pose, one for each rest of the rotor.
/// Currents do not matter: coils may hold the rotor, or a hand.
class TrackedPoseStreams {
 public:
  /// Throws ConfigError when the options are not valid.
  TrackedPoseStreams(const Actuator& actuator, const SampleBuilderOptions& options);

  void add(const sensor_msgs::JointState& message);
  void add(const geometry_msgs::PoseStamped& message);
  /// No more messages of this base of time follow.
  void finish() { builder_.finish(); }

  /// Poses of the rests that ended since the last call, ids counted from 1.
  std::vector<TrackedPose> takePoses();

  /// The pose of the present rest, averaged over `duration` seconds from stamp `from` on; nothing
  /// while the rotor moves or measurements are missing.
  std::optional<TrackedPose> capture(Stamp from, double duration) const;
  /// Newest stamp of both streams.
  std::optional<Stamp> newest() const { return builder_.newest(); }

  /// What came, and what is wrong with it: sentences for an operator; none where all is well.
  std::vector<std::string> notes() const;

 private:
  JointStateReader joint_reader_;
  SampleBuilder builder_;
  std::string tracker_frame_;  ///< of the first pose
  std::uint64_t incomplete_joint_states_ = 0;
  std::uint64_t poses_in_other_frame_ = 0;
};

/// Poses of recordings, and what an operator should know of them.
struct RecordedPoses {
  std::vector<TrackedPose> poses;
  std::vector<std::string> notes;
};

/// Reads joint_states and tracker/pose of one actuator, below the namespace `ns`, out of
/// recordings. `progress` is told the share done (0 to 1). Throws DataError, naming the file, for
/// bags that cannot be read, lack a topic or are of another unit; ConfigError when the options are
/// not valid.
RecordedPoses readTrackedPoses(const std::vector<std::string>& paths,
                               const Actuator& actuator,
                               const std::string& ns,
                               const SampleBuilderOptions& options,
                               const std::function<void(double)>& progress);

}  // namespace sac
