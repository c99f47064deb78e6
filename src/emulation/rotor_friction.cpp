#include "spherical_actuator_calibration/emulation/rotor_friction.hpp"

#include <cmath>

#include <Eigen/LU>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Friction torque per angular velocity [N·m·s].
double damping(const BearingFriction& friction, const Eigen::Vector3d& w) {
  return friction.viscous + friction.coulomb / std::hypot(w.norm(), friction.transition);
}

}  // namespace

void validate(const BearingFriction& friction) {
  requireInRange("viscous friction", friction.viscous, ValueRange::nonNegative("N m s"));
  requireInRange("coulomb friction", friction.coulomb, ValueRange::nonNegative("N m"));
  requireInRange("transition of friction", friction.transition, ValueRange::positive("rad/s"));
}

// Implicit, so that friction never turns the rotor around; with the damping of the middle of the
// step, so that it is good to second order.
Eigen::Vector3d slowedBy(const BearingFriction& friction,
                         const Eigen::Matrix3d& inertia,
                         const Eigen::Vector3d& angular_velocity,
                         double step) {
  const auto implicitly = [&](const Eigen::Vector3d& w, double duration) -> Eigen::Vector3d {
    const double factor = duration * damping(friction, w);
    return (inertia + factor * Eigen::Matrix3d::Identity()).inverse() *
           (inertia * angular_velocity);
  };
  const Eigen::Vector3d middle = implicitly(angular_velocity, 0.5 * step);
  const double change = 0.5 * step * damping(friction, middle);
  const Eigen::Vector3d slower =
      (inertia + change * Eigen::Matrix3d::Identity()).inverse() *
      ((inertia - change * Eigen::Matrix3d::Identity()) * angular_velocity);
  // The midpoint rule goes beyond rest where the step is long against the friction.
  const bool turns_around = slower.dot(inertia * angular_velocity) <= 0.0;
  return turns_around ? implicitly(middle, step) : slower;
}

}  // namespace sac
