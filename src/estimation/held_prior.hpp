#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/least_squares.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Variance of a coordinate by its size as it is stated beforehand; 0 where none is.
double statedVariance(const ParameterSpace& space, Eigen::Index coordinate);

/// Those of the coordinates whose size is stated beforehand. That counts in every cycle as if none
/// had run before: a cycle that estimates them uses all samples that tell them.
std::vector<Eigen::Index> statedOf(const ParameterSpace& space,
                                   const std::vector<Eigen::Index>& coordinates);

/// What counts beside observations: the prior along the directions that are held (orthonormal
/// columns), and the stated sizes among the estimated coordinates.
LinearPrior heldPrior(const EstimationProblem& problem,
                      const Eigen::MatrixXd& directions,
                      const std::vector<Eigen::Index>& estimated);

}  // namespace sac
