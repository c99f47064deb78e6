#pragma once

#include <string>

#include "spherical_actuator_calibration/planning/planning_problem.hpp"
#include "spherical_actuator_calibration/planning/pose_plan.hpp"

namespace sac {

/// What a plan of poses gives, for an operator.
std::string planSentence(const PosePlan& plan, const PosePlanOptions& options);

/// What it leaves open, and that more is needed.
std::string openSentence(const PosePlan& plan);

}  // namespace sac
