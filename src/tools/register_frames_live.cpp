#include "register_frames_live.hpp"

#include <cstdint>
#include <cstdio>

#include <geometry_msgs/PoseStamped.h>
#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/recording/tracked_pose_streams.hpp"

namespace sac {
namespace {

constexpr std::uint32_t kQueueLength = 10000;
constexpr double kBeat = 0.05;         // [s]
constexpr int kBeatsUntilNotes = 100;  // without a pose
constexpr double kPatience = 2.0;      // [s] of stamps before a capture begins anew

/// Takes the poses of one session.
class LivePoses {
 public:
  LivePoses(const CalibratedDescription& description,
            const CalibrationConfig& config,
            const LiveRegistrationOptions& options)
      : description_(description),
        config_(config),
        options_(options),
        streams_(description.actuator, config.samples) {}

  void subscribe(ros::NodeHandle& node) {
    subscribers_.push_back(subscribeChecked<sensor_msgs::JointState>(
        node,
        "joint_states",
        kQueueLength,
        [this](const sensor_msgs::JointState::ConstPtr& message) { streams_.add(*message); },
        tellRefusal("joint_states")));
    subscribers_.push_back(subscribeChecked<geometry_msgs::PoseStamped>(
        node,
        "tracker/pose",
        kQueueLength,
        [this](const geometry_msgs::PoseStamped::ConstPtr& message) { streams_.add(*message); },
        tellRefusal("tracker/pose")));
  }

  /// True when there are enough.
  bool beat() {
    // On a busy computer a rest may be over before it was looked at.
    for (TrackedPose& pose : streams_.takePoses()) {
      if (add(pose)) {
        return true;
      }
    }
    const std::optional<Stamp> newest = streams_.newest();
    if (!newest) {
      tellSilence();
      return false;
    }
    if (!begin_ || secondsBetween(*begin_, *newest) > options_.duration + kPatience ||
        *newest < *begin_) {
      begin_ = *newest;
    }
    if (std::optional<TrackedPose> pose = streams_.capture(*begin_, options_.duration)) {
      begin_.reset();
      return add(*pose);
    }
    tellSilence();
    return false;
  }

  std::vector<TrackedPose> take() { return std::move(poses_); }

 private:
  bool add(TrackedPose& pose) {
    std::vector<TrackedPose> with = poses_;
    pose.id = static_cast<std::uint32_t>(poses_.size() + 1);
    with.push_back(pose);
    if (differentPoses(description_, with) <= differentPoses(description_, poses_)) {
      return false;  // it rests where it was
    }
    poses_ = std::move(with);
    beats_ = 0;
    std::printf("Pose %zu of %zu is taken", poses_.size(), options_.poses);
    if (poses_.size() < options_.poses) {
      std::printf("; turn the rotor to another one.\n");
      std::fflush(stdout);
      return false;
    }
    std::printf(".\n");
    const FrameRegistration result = registerFrames(description_, poses_, config_.estimation);
    if (!result.success) {
      std::printf("%s\n", result.message.c_str());
    }
    std::fflush(stdout);
    return result.success;
  }

  void tellSilence() {
    if (++beats_ == kBeatsUntilNotes) {
      for (const std::string& note : streams_.notes()) {
        std::printf("%s\n", note.c_str());
      }
      std::fflush(stdout);
    }
  }

  const CalibratedDescription& description_;
  const CalibrationConfig& config_;
  const LiveRegistrationOptions& options_;
  TrackedPoseStreams streams_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<TrackedPose> poses_;
  std::optional<Stamp> begin_;
  int beats_ = 0;
};

}  // namespace

void initializeRos(int argc, char** argv) {
  ros::init(argc,
            argv,
            "register_frames",
            ros::init_options::NoSigintHandler | ros::init_options::AnonymousName);
  handleTerminationSignals();
  endStartAfterSignal();
}

CalibratedDescription describedActuator(const std::string& ns) {
  return loadDescriptionParameter(ros::NodeHandle(ns));
}

std::vector<TrackedPose> takePosesLive(const CalibratedDescription& description,
                                       const CalibrationConfig& config,
                                       const LiveRegistrationOptions& options) {
  ros::NodeHandle node(options.ns);
  LivePoses poses(description, config, options);
  poses.subscribe(node);
  endStart();
  std::printf(
      "Turn the rotor, by hand or by coils, and let it rest for %.1f s in each of %zu poses; "
      "Ctrl-C ends with those that are taken.\n",
      options.duration + config.samples.rest_window,
      options.poses);
  std::fflush(stdout);
  while (ros::ok() && !terminationRequested()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kBeat));
    if (poses.beat()) {
      break;
    }
  }
  return poses.take();
}

}  // namespace sac
