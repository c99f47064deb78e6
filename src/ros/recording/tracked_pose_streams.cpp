#include "spherical_actuator_calibration/ros/recording/tracked_pose_streams.hpp"

#include <algorithm>
#include <exception>
#include <memory>

#include "bag_files.hpp"
#include "bag_reader.hpp"
#include "damaged_recording.hpp"
#include "recorded_topics.hpp"
#include "recorded_unit.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/message_decoder.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

namespace sac {
namespace {

/// Throws DataError unless the bag has the topic, or has it with another type.
template <typename Message>
void requireTopic(const BagGroup& bags, const std::string& name) {
  bool is_recorded = false;
  for (const BagFile* file : bags) {
    for (const BagTopic& topic : file->topics) {
      if (topic.name != name) {
        continue;
      }
      is_recorded = true;
      requireMessageType(*file,
                         topic,
                         ros::message_traits::datatype<Message>(),
                         ros::message_traits::md5sum<Message>());
    }
  }
  if (!is_recorded) {
    throw DataError(pathsOf(bags) + ": no message of " + name +
                    "; record it, or name the right namespace by --ns.");
  }
}

/// Reads groups of bags, one after the other.
class PoseReader {
 public:
  PoseReader(const Actuator& actuator, const std::string& ns, const SampleBuilderOptions& options)
      : actuator_(actuator),
        topics_(ns),
        joint_states_(topics_.name(TopicRole::kJointStates)),
        tracker_poses_(topics_.prefix() + "tracker/pose"),
        streams_(actuator, options) {}

  RecordedPoses read(const std::vector<std::string>& paths,
                     const std::function<void(double)>& progress) {
    const std::vector<std::unique_ptr<BagFile>> bags = openBags(paths);
    for (const BagGroup& group : groupBags(bags, topics_.prefix())) {
      requireTopic<sensor_msgs::JointState>(group, joint_states_);
      requireTopic<geometry_msgs::PoseStamped>(group, tracker_poses_);
      readUndamaged(pathsOf(group), [&] {
        readUnit(group);
        readGroup(group, progress);
      });
    }
    return {streams_.takePoses(), streams_.notes()};
  }

 private:
  void readUnit(const BagGroup& group) {
    for (BagFile* file : group) {
      BagReader reader({file}, {topics_.name(TopicRole::kParameters)});
      BagMessage message;
      while (reader.next(message)) {
        requireSameUnit(file->path, decoder_.decode(message.data, unit_), actuator_);
      }
    }
  }

  void readGroup(const BagGroup& group, const std::function<void(double)>& progress) {
    BagReader reader(group, {joint_states_, tracker_poses_});
    const ros::Time begin = reader.begin();
    const double duration = secondsBetween(begin, reader.end());
    std::uint64_t count = 0;
    BagMessage message;
    while (reader.next(message)) {
      if (message.connection->topic == joint_states_) {
        streams_.add(decoder_.decode(message.data, joint_state_));
      } else {
        streams_.add(decoder_.decode(message.data, pose_));
      }
      if (++count % kProgressStep == 0 && progress) {
        progress(std::min(1.0, secondsBetween(begin, message.time) / duration));
      }
    }
    if (progress) {
      progress(1.0);
    }
    streams_.finish();
  }

  const Actuator& actuator_;
  RecordedTopics topics_;
  std::string joint_states_;
  std::string tracker_poses_;
  TrackedPoseStreams streams_;

  // Storage that is reused from message to message.
  MessageDecoder decoder_;
  sensor_msgs::JointState joint_state_;
  geometry_msgs::PoseStamped pose_;
  RecordedUnit unit_;
};

}  // namespace

TrackedPoseStreams::TrackedPoseStreams(const Actuator& actuator,
                                       const SampleBuilderOptions& options)
    : joint_reader_(jointNames(actuator)), builder_(options, 0) {}

void TrackedPoseStreams::add(const sensor_msgs::JointState& message) {
  if (const std::optional<JointMeasurement> joints = joint_reader_.read(message)) {
    builder_.add(*joints);
  } else {
    ++incomplete_joint_states_;
  }
}

void TrackedPoseStreams::add(const geometry_msgs::PoseStamped& message) {
  if (tracker_frame_.empty()) {
    tracker_frame_ = message.header.frame_id;
  }
  if (message.header.frame_id != tracker_frame_) {
    ++poses_in_other_frame_;
    return;
  }
  // The builder averages any orientation; this one is of the marker in the tracker.
  builder_.add(OrientationMeasurement{stampFromRos(message.header.stamp),
                                      quaternionFromRos(message.pose.orientation)});
}

std::vector<TrackedPose> TrackedPoseStreams::takePoses() {
  return trackedPoses(builder_.takeSamples());
}

std::optional<TrackedPose> TrackedPoseStreams::capture(Stamp from, double duration) const {
  const CaptureProgress progress = builder_.capture(from, duration);
  if (progress.state != CaptureProgress::State::kDone || !progress.sample->has_orientation) {
    return std::nullopt;
  }
  return trackedPoses({*progress.sample}).front();
}

std::vector<std::string> TrackedPoseStreams::notes() const {
  const SampleBuilderReport& report = builder_.report();
  std::vector<std::string> notes;
  if (incomplete_joint_states_ > 0) {
    notes.push_back(std::to_string(incomplete_joint_states_) +
                    " joint states lack a joint of the description.");
  }
  if (poses_in_other_frame_ > 0) {
    notes.push_back(std::to_string(poses_in_other_frame_) +
                    " tracker poses are in another frame than the first one, " + tracker_frame_ +
                    ", and were left out.");
  }
  if (report.joints.received == 0) {
    notes.emplace_back("No joint states came.");
  }
  if (report.orientations.received == 0) {
    notes.emplace_back("No tracker poses came.");
  }
  return notes;
}

RecordedPoses readTrackedPoses(const std::vector<std::string>& paths,
                               const Actuator& actuator,
                               const std::string& ns,
                               const SampleBuilderOptions& options,
                               const std::function<void(double)>& progress) {
  return PoseReader(actuator, ns, options).read(paths, progress);
}

}  // namespace sac
