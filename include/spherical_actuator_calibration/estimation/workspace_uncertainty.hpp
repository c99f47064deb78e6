#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// How good a calibration is where the rotor may go: the 95th percentile over poses of the
/// workspace (tilt within its limit, full spin) of the expected (1 σ, root of the trace) error.
struct WorkspaceUncertainty {
  double orientation = 0.0;  ///< of the rotor orientation [rad]
  double torque = 0.0;  ///< of the torque per ampere of one coil [N·m/A]; 0 without torque model
};

/// Propagates the covariance of the coordinates through the forward models at `poses` evenly spread
/// (Halton) poses.
WorkspaceUncertainty workspaceUncertainty(const CalibrationModel& model,
                                          const ParameterBelief& belief,
                                          int poses = 100);

/// Where the calibration is good and where it is not: the same expected errors over the tilt of the
/// rotor, as root mean square over its spin.
struct WorkspaceMap {
  Eigen::VectorXd tilt;  ///< positions of joint 1 (rows) and of joint 2 (columns), ascending [rad]
  Eigen::MatrixXd orientation;  ///< [rad]
  Eigen::MatrixXd torque;       ///< also over the coils [N·m/A]; empty without torque model
};

/// Propagates the covariance at `tilts`² (at least 2²) positions of joints 1 and 2 over the
/// workspace, each at `spins` positions of joint 3 around the whole turn.
WorkspaceMap workspaceMap(const CalibrationModel& model,
                          const ParameterBelief& belief,
                          int tilts = 13,
                          int spins = 12);

}  // namespace sac
