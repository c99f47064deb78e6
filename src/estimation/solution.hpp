#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"
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

}  // namespace sac
