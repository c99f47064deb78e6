#pragma once

#include "spherical_actuator_calibration/planning/pose_plan.hpp"

namespace sac {

struct PlanningProblem;
struct PosePlanOptions;

/// Chooses the poses, and the coils to excite at each, that add most to what the cycle will know.
///
/// First, poses that increase the determinant of the information matrix most (with a weak prior),
/// one after the other; then every pose is exchanged as long as that serves the criterion. No pole
/// lies where the curve is uncertain when a coil is excited. With patterns of several coils,
/// patterns and poses are exchanged for the largest standard deviation, whatever the criterion. An
/// orientation counts once per pose, whatever the number of torques measured there: a tracker's
/// errors hardly change while the rotor rests. The expected standard deviations are those that the
/// cycle itself reports for noise-free samples.
///
/// Throws ConfigError when options or request are not valid.
PosePlan planPoses(const PlanningProblem& problem, const PosePlanOptions& options);

}  // namespace sac
