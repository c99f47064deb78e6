#pragma once

#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// Answer of the service plan_poses.
msg::PlanPoses::Response planToRos(const PosePlan& plan);

}  // namespace sac
