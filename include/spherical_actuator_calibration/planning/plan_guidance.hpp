#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

struct PlannedPose;

/// What the operator of a plan does next, in a sentence with the pose [rad and degrees] and the
/// coils; empty when each pose is measured. A pose is measured when samples at it, held out or not,
/// have each of its patterns or its opposite, or when one is there where it has none.
/// `current_threshold` [A]: a coil below it counts as off. Without joints the pose is told as
/// turns.
std::string planStep(const std::vector<PlannedPose>& poses,
                     const std::vector<Sample>& samples,
                     double current_threshold,
                     bool has_joints = true);

}  // namespace sac
