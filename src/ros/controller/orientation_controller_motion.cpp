// What the orientation controller does about motion plans.
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan_file.hpp"
#include "spherical_actuator_calibration/ros/controller/orientation_controller_node.hpp"

namespace sac {
namespace {

const char* inWords(MotionPhase phase) {
  switch (phase) {
    case MotionPhase::kNone:
      return "No motion was begun.";
    case MotionPhase::kApproach:
      return "The rotor turns to where the motion begins.";
    case MotionPhase::kMotion:
      return "The rotor follows the motion.";
    case MotionPhase::kEnding:
    case MotionPhase::kSettling:
      return "The motion slows down to rest.";
    case MotionPhase::kDone:
      return "The motion is over, the currents are zero.";
    case MotionPhase::kStopped:
      return "The motion has stopped, the currents are zero";
  }
  return "";
}

}  // namespace

bool OrientationControllerNode::followMotion(msg::FollowMotion::Request& request,
                                             msg::FollowMotion::Response& response) {
  constexpr std::size_t kLongestPlan = 1U << 20U;  // [byte]
  try {
    if (request.plan.size() > kLongestPlan) {
      throw DataError("The motion plan is longer than 1 MB.");
    }
    // Read without the mutex: the control goes on.
    const MotionPlan plan = parseMotionPlan(request.plan, "plan").plan;
    const std::lock_guard<std::mutex> lock(mutex_);
    controller_.follow(plan);
    // So that an end before the next report is told as well.
    told_phase_ = MotionPhase::kNone;
    response.success = 1;
    response.message = "The rotor turns to where the motion begins, and follows it.";
  } catch (const Error& error) {
    response.success = 0;
    response.message = "The motion is refused: " + printable(error.what());
    const std::lock_guard<std::mutex> lock(mutex_);
    last_refusal_ = "follow_motion: " + printable(error.what());
  }
  return true;
}

bool OrientationControllerNode::endMotion(std_srvs::Trigger::Request& /*request*/,
                                          std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  controller_.endMotion();
  commandEnd();
  response.success = 1;
  response.message = "No motion goes on, or it slows down to its end.";
  return true;
}

void OrientationControllerNode::tellMotion() {
  msg::MotionStatus message;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const MotionProgress progress = controller_.motionProgress();
    if (progress.phase == told_phase_ && !isRunning(progress.phase)) {
      return;
    }
    told_phase_ = progress.phase;
    message.phase = motionPhaseName(progress.phase);
    message.message = inWords(progress.phase);
    if (progress.phase == MotionPhase::kStopped) {
      message.message +=
          ": " + (controller_.stopReason().empty() ? "disabled" : controller_.stopReason());
      message.is_lost = static_cast<std::uint8_t>(controller_.isLost());
    }
    message.elapsed = progress.elapsed;
    message.duration = progress.duration;
    message.tracking_error = controller_.trackingError();
    message.largest_tracking_error = progress.largest_tracking_error;
    message.excitation_share = progress.least_excitation_share;
    message.torque_share = progress.least_torque_share;
  }
  message.header.stamp = ros::Time::now();
  motion_publisher_.publish(message);
}

}  // namespace sac
