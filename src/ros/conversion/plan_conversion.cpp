#include "spherical_actuator_calibration/ros/conversion/plan_conversion.hpp"

#include <algorithm>
#include <iterator>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {

msg::PlanPoses::Response planToRos(const PosePlan& plan) {
  msg::PlanPoses::Response message;
  message.success = static_cast<std::uint8_t>(plan.success);
  message.message = plan.message;
  for (const PlannedPose& pose : plan.poses) {
    msg::PlannedPose& item = message.poses.emplace_back();
    for (std::size_t k = 0; k < kJoints; ++k) {
      item.joint_position[k] = pose.joint_position[static_cast<Eigen::Index>(k)];
    }
    for (const std::size_t coil : pose.coils) {
      item.coils.push_back(static_cast<std::uint32_t>(numberOf(coil)));
    }
  }
  std::transform(plan.expected.begin(),
                 plan.expected.end(),
                 std::back_inserter(message.expected),
                 estimateToRos);
  return message;
}

}  // namespace sac
