#pragma once

#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Nine tenths of the torques that stand out of their noise are smaller [N·m]; 0 where none does.
/// What is measured does not depend on what is supposed of coils and currents: an allowance in
/// proportion to it is the same for all hypotheses. `assumed_stddev`: of torques that state none.
double largeTorque(const std::vector<Sample>& samples, double assumed_stddev);

}  // namespace sac
