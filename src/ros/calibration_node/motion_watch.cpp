#include "spherical_actuator_calibration/ros/calibration_node/motion_watch.hpp"

#include <cstdint>
#include <utility>

#include <ros/time.h>
#include <spherical_actuator_calibration/MotionProgress.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/latched_publishing.hpp"

namespace sac {
namespace {

constexpr double kUnknown = -1.0;

msg::GroupUncertainty toRos(const GroupUncertainty& group) {
  msg::GroupUncertainty message;
  message.group = group.group;
  message.least_known = group.least_known;
  message.stddev = group.stddev;
  message.parameters = group.parameters;
  message.left = group.left;
  return message;
}

}  // namespace

MotionWatch::MotionWatch(ros::NodeHandle node,
                         const Actuator& nominal,
                         const CalibrationConfig& config,
                         double wanted_stddev)
    : nominal_(nominal), config_(config), wanted_stddev_(wanted_stddev) {
  if (MotionFollower::suits(nominal)) {
    constexpr std::uint32_t kProgressQueueLength = 100;
    constexpr bool kIsLatched = true;
    publisher_ =
        node.advertise<msg::MotionProgress>("motion_progress", kProgressQueueLength, kIsLatched);
    forget();
  }
}

void MotionWatch::add(MotionSlice window) {
  if (follower_) {
    follower_->add(std::move(window));
    publish();
  }
}

void MotionWatch::forget(std::optional<double> wanted_stddev) {
  if (MotionFollower::suits(nominal_)) {
    follower_ =
        std::make_unique<MotionFollower>(nominal_, config_, wanted_stddev.value_or(wanted_stddev_));
    publish();
  }
}

bool MotionWatch::canBeJudged() const {
  return follower_ && follower_->canBeJudged();
}

void MotionWatch::publish() {
  const LiveEstimate& estimate = follower_->estimate();
  msg::MotionProgress message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = config_.frames.stator;
  message.told = estimate.is_told ? 1 : 0;
  message.windows = static_cast<std::uint32_t>(estimate.windows);
  message.left_out = static_cast<std::uint32_t>(estimate.left_out);
  message.duration = estimate.duration;
  message.orientations = static_cast<std::uint32_t>(estimate.orientations);
  message.reduced_chi_square = estimate.chi_square;
  for (const GroupUncertainty& group : follower_->groups()) {
    message.groups.push_back(toRos(group));
  }
  message.wanted_stddev = follower_->wantedStddev();
  message.time_left = follower_->timeLeft().value_or(kUnknown);
  message.is_enough = follower_->isEnough() ? 1 : 0;
  message.message = follower_->inWords();
  for (const ParameterEstimate& one : follower_->dynamics()) {
    message.dynamics.push_back(estimateToRos(one));
  }
  publishLatched(publisher_, message);
}

}  // namespace sac
