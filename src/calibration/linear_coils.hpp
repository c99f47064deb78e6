#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Errors of an axis that are a small part of the width of the torque curve's peak [rad].
inline constexpr double kLinearRange = 0.01;

/// Of poles and coils, beside what is due to joints and effects: what turns with them, as all axes
/// do with a tracker or without one, changes no torque. Those of joints and effects are zero.
Eigen::VectorXd variancesBesideCommon(const ParameterSpace& space,
                                      const Eigen::MatrixXd& covariance);

/// For each coil, whether a torque is close to linear over the uncertainty of its axis: its angles
/// are identified, and known to kLinearRange, where joints and effects are known. What turns with
/// them, as all axes do with a tracker, changes no torque.
std::vector<bool> linearCoils(const ParameterSpace& space,
                              const ParameterBelief& belief,
                              const std::vector<bool>& identified);

}  // namespace sac
