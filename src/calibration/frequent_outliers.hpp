#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// Streams and coils of which more was left out as outliers than accidents take, in sentences.
std::vector<std::string> frequentOutliers(const EstimationProblem& problem,
                                          const Estimate& estimate,
                                          const EstimationOptions& options);

}  // namespace sac
