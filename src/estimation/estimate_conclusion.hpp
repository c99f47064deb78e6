#pragma once

#include "solution.hpp"
#include "spherical_actuator_calibration/estimation/estimate.hpp"

namespace sac {

/// Fills what an estimate says of a solution: belief, condition number, χ², residuals, errors.
void conclude(const Solution& solution, Estimate& estimate);

}  // namespace sac
