#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// Coordinates that the cycle has estimated, at least in part; ascending.
std::vector<Eigen::Index> estimatedCoordinates(const ParameterSpace& space,
                                               const CycleReport& report);

/// Observations of the problem that the cycle has not rejected, ascending.
std::vector<std::size_t> keptObservations(const EstimationProblem& problem,
                                          const CycleReport& report);

/// What held the open directions of the cycle, as information on `coordinates`: the prior, whose
/// uncertainty along them is still that of the belief after it.
Eigen::MatrixXd priorInformation(const std::vector<OpenDirection>& open,
                                 const ParameterBelief& after,
                                 const std::vector<Eigen::Index>& coordinates);

}  // namespace sac
