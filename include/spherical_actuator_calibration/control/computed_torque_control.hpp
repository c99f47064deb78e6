#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"

namespace sac {

/// Gains of the control on SO(3).
struct ControlGains {
  double proportional = 100.0;  ///< of the rotation error [1/s²]
  double derivative = 20.0;     ///< of the velocity error [1/s]
};

/// Throws ConfigError that names the gain and its range.
void validate(const ControlGains& gains);

/// The same actuator. Throws ConfigError unless it is valid, and has the poles, coils and torque
/// curve of a torque model.
const Actuator& controllable(const Actuator& actuator);

/// A desired motion at one time. Velocity and acceleration in the desired rotor frame.
struct DesiredMotion {
  Eigen::Matrix3d R_stator_rotor = Eigen::Matrix3d::Identity();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< [rad/s²]
};

/// Torque of the coils [N·m, rotor frame] by computed torque with proportional and derivative
/// action on SO(3), gravity fed forward: T = J (α_d + K_p ln(Rᵀ R_d)^∨ + K_d (Rᵀ R_d ω_d − ω)) + ω
/// × Jω − T_gravity. `state` is the rotor as the model sees it.
Eigen::Vector3d computedTorque(const RigidRotor& rotor,
                               const RotorState& state,
                               const DesiredMotion& desired,
                               const ControlGains& gains);

/// The desired orientation R_stator_rotor at which computedTorque() would ask for `torque`, with
/// velocity and acceleration of `desired`: for a transfer to other parameters without a jump.
Eigen::Matrix3d orientationForTorque(const RigidRotor& rotor,
                                     const RotorState& state,
                                     const DesiredMotion& desired,
                                     const Eigen::Vector3d& torque,
                                     const ControlGains& gains);

}  // namespace sac
