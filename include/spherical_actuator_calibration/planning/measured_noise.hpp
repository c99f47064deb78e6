#pragma once

#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/planning/planning_problem.hpp"

namespace sac {

/// The options with the standard deviations that samples at hand have, instead of those that are
/// expected before anything is measured: the median of the samples, of each kind of reading on its
/// own, held-out ones included. What no sample tells stays as it is. So a plan promises what this
/// machine and this length of capture give.
PosePlanOptions withMeasuredNoise(PosePlanOptions options, const std::vector<Sample>& held);

}  // namespace sac
