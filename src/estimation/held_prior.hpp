#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"
#include "spherical_actuator_calibration/estimation/stated_knowledge.hpp"

namespace sac {

/// What counts beside observations: the prior along the directions that are held (orthonormal
/// columns), and what is stated of the estimated coordinates.
LinearPrior heldPrior(const EstimationProblem& problem,
                      const Eigen::MatrixXd& directions,
                      const std::vector<Eigen::Index>& estimated);

}  // namespace sac
