#pragma once

#include "spherical_actuator_calibration/core/calibration_model.hpp"
#include "spherical_actuator_calibration/core/estimation_problem.hpp"

namespace spherical_actuator_calibration {

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

}  // namespace spherical_actuator_calibration
