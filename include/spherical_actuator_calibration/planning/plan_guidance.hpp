#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

struct PlannedPose;

/// What the operator of a plan does next, in a sentence with the pose [rad and degrees] and the
/// coils; empty when each pose is measured. A pose is measured when samples in use near it, by 0.1
/// rad in each joint as a hand meets it, have each of its patterns or its opposite, or none where
/// it has none. `current_threshold` [A]: a coil below it counts as off.
std::string planStep(const std::vector<PlannedPose>& poses,
                     const std::vector<Sample>& samples,
                     double current_threshold);

}  // namespace sac
