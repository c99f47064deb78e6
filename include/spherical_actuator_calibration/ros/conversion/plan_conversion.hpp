#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

struct PosePlan;
struct PosePlanOptions;

/// Options of the service plan_poses: what a request leaves at zero is as by default. Throws
/// ConfigError when it names patterns that there are not.
PosePlanOptions planOptionsFromRos(const msg::PlanPoses::Request& request);

/// Poses of a plan. `current`: of an excited coil [A]; `coils`: of the actuator.
std::vector<msg::PlannedPose> posesToRos(const PosePlan& plan, double current, std::size_t coils);

/// Answer of the service plan_poses; arguments as of posesToRos().
msg::PlanPoses::Response planToRos(const PosePlan& plan, double current, std::size_t coils);

}  // namespace sac
