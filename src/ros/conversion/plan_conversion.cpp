#include "spherical_actuator_calibration/ros/conversion/plan_conversion.hpp"

#include <algorithm>
#include <iterator>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/planning/pose_plan.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {

PosePlanOptions planOptionsFromRos(const msg::PlanPoses::Request& request) {
  PosePlanOptions options;
  options.max_poses = request.max_poses;
  options.wanted_stddev = request.wanted_stddev;
  if (request.patterns == "weighing") {
    options.patterns = PlanPatterns::kWeighing;
  } else if (!request.patterns.empty() && request.patterns != "single") {
    throw ConfigError("patterns: \"" + printable(request.patterns) +
                      "\" is neither single nor weighing.");
  }
  if (request.current != 0.0) {
    options.current = request.current;
  }
  if (request.total_current != 0.0) {
    options.total_current = request.total_current;
  }
  return options;
}

std::vector<msg::PlannedPose> posesToRos(const PosePlan& plan, double current, std::size_t coils) {
  std::vector<msg::PlannedPose> poses;
  for (const PlannedPose& pose : plan.poses) {
    msg::PlannedPose& item = poses.emplace_back();
    for (std::size_t k = 0; k < kJoints; ++k) {
      item.joint_position[k] = pose.joint_position[static_cast<Eigen::Index>(k)];
    }
    for (const std::size_t coil : pose.coils) {
      item.coils.push_back(static_cast<std::uint32_t>(numberOf(coil)));
    }
    for (const CoilPattern& pattern : pose.patterns) {
      std::vector<double>& currents = item.patterns.emplace_back().current;
      currents.assign(coils, 0.0);
      for (const SignedCoil& coil : pattern) {
        currents.at(coil.coil) = coil.sign * current;
      }
    }
  }
  return poses;
}

msg::PlanPoses::Response planToRos(const PosePlan& plan, double current, std::size_t coils) {
  msg::PlanPoses::Response message;
  message.success = static_cast<std::uint8_t>(plan.success);
  message.message = plan.message;
  message.poses = posesToRos(plan, current, coils);
  message.stddev_bound = plan.stddev_bound.value_or(0.0);
  std::transform(plan.expected.begin(),
                 plan.expected.end(),
                 std::back_inserter(message.expected),
                 estimateToRos);
  return message;
}

}  // namespace sac
