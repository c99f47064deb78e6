#pragma once

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// Solves the problem: weighted least squares by Levenberg–Marquardt. Where the first solution
/// shows misfits, a robust pass finds outliers and a final solution runs without them. What the
/// data cannot tell keeps its prior: see unidentified_part.hpp. Never throws for poor data: see
/// termination. Throws DataError on inconsistent input (index out of range, torque without a torque
/// model).
Estimate estimate(const EstimationProblem& problem, const EstimationOptions& options);

}  // namespace sac
