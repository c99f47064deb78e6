#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "weighted_observations.hpp"

namespace sac {

/// Where the iteration of an estimation ended.
struct Solution {
  const EstimationProblem* problem = nullptr;
  const EstimationOptions* options = nullptr;
  const WeightedObservations* observations = nullptr;  ///< with the weights at `path.back()`
  std::vector<Eigen::Index> estimated;                 ///< coordinates, ascending
  LinearPrior prior;                                   ///< of the directions that are held
  std::vector<Eigen::VectorXd> path;                   ///< from the prior to the solution

  const Eigen::VectorXd& x() const { return path.back(); }
};

/// Fills what an estimate says of a solution: belief, condition number, χ², residuals, errors.
void conclude(const Solution& solution, Estimate& estimate);

}  // namespace sac
