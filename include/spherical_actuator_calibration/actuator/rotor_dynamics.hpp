#pragma once

#include <functional>

#include <Eigen/Core>

namespace sac {

/// A rotor as a rigid body that turns about the centre of the actuator.
struct RigidRotor {
  /// Inertia about the centre, rotor frame [kg·m²]; symmetric, positive definite. Default: that of
  /// the paper's rotor (doc/method.md, Dynamics).
  Eigen::Matrix3d inertia = Eigen::Vector3d(0.7e-3, 0.7e-3, 1.3e-3).asDiagonal();
  /// Weight times the position of the centre of gravity, rotor frame [N·m].
  Eigen::Vector3d unbalance = Eigen::Vector3d::Zero();
};

/// Throws ConfigError unless inertia and unbalance can be those of a body.
void validate(const RigidRotor& rotor);

/// Where the rotor is, and how it turns.
struct RotorState {
  Eigen::Matrix3d R_stator_rotor = Eigen::Matrix3d::Identity();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rotor frame [rad/s]
};

/// Direction of gravity, along −z of the stator, in the rotor frame.
Eigen::Vector3d gravityDirection(const Eigen::Matrix3d& R_stator_rotor);

/// Torque of gravity (along −z of the stator) about the centre, rotor frame [N·m].
Eigen::Vector3d gravityTorque(const RigidRotor& rotor, const Eigen::Matrix3d& R_stator_rotor);

/// Torque of the coils on the rotor, rotor frame [N·m], at an orientation within a step.
using CoilTorque = std::function<Eigen::Vector3d(const Eigen::Matrix3d& R_stator_rotor)>;

/// State after `step` [s], by a Runge–Kutta–Munthe-Kaas method of fourth order on SO(3): the
/// orientation stays a rotation, and energy is conserved to the order of the step.
RotorState advance(const RigidRotor& rotor,
                   const RotorState& state,
                   const CoilTorque& torque,
                   double step);

}  // namespace sac
