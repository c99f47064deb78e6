#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// ∂reported/∂coordinates at x, by central differences: axes turn smoothly into their angles.
Eigen::MatrixXd reportedJacobian(const ParameterSpace& space, const Eigen::VectorXd& x);

/// Covariance of the reported values of all parameters in force (CalibrationSession::parameters()),
/// in their units and order, to first order.
Eigen::MatrixXd reportedCovariance(const CalibrationSession& session);

}  // namespace sac
