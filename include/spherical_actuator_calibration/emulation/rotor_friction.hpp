#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// Friction of a rotor in its bearing: T = −(b + c / √(‖ω‖² + v²)) ω.
struct BearingFriction : RotorFriction {
  double transition = 0.05;  ///< v, below which dry friction fades [rad/s]
};

/// Throws ConfigError that names the key, its value and the allowed range.
void validate(const BearingFriction& friction);

/// Angular velocity after `step` [s] in which friction alone acts on a body of this inertia
/// [kg·m²]: to second order of the step, and never beyond rest, however long it is.
Eigen::Vector3d slowedBy(const BearingFriction& friction,
                         const Eigen::Matrix3d& inertia,
                         const Eigen::Vector3d& angular_velocity,
                         double step);

}  // namespace sac
