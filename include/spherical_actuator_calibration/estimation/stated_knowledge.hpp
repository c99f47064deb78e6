#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Variance of a coordinate by its size as it is stated beforehand; 0 where none is.
double statedVariance(const ParameterSpace& space, Eigen::Index coordinate);

/// Those of the coordinates whose size is stated beforehand. That counts in every cycle as if none
/// had run before: a cycle that estimates them uses all samples that tell them.
std::vector<Eigen::Index> statedOf(const ParameterSpace& space,
                                   const std::vector<Eigen::Index>& coordinates);

/// Covariance of these coordinates as it is stated beforehand, a row and a column of each; zero
/// where nothing is.
Eigen::MatrixXd statedCovariance(const ParameterSpace& space,
                                 const std::vector<Eigen::Index>& coordinates);

/// What that knowledge, of mean zero, tells of these coordinates while nothing is known of all
/// others: the inverse of their covariance, zero where nothing is stated.
Eigen::MatrixXd statedInformation(const ParameterSpace& space,
                                  const std::vector<Eigen::Index>& coordinates);

}  // namespace sac
