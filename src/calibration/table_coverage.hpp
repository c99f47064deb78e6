#pragma once

#include <string>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/estimator.hpp"

namespace sac {

/// That torques, outliers among them, were measured at angles between pole and coil beyond the last
/// point of a torque table which ends before the torque does: the curve is a guess there. Empty
/// where none were.
std::string tableCoverageInWords(const EstimationProblem& problem,
                                 const Estimate& estimate,
                                 const EstimationOptions& options);

}  // namespace sac
