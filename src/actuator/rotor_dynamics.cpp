#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/symmetric_matrix.hpp"

namespace sac {
namespace {

/// Rate of change of the state, its rotation as a rotation vector from the begin of the step.
struct Rate {
  Eigen::Vector3d rotation;
  Eigen::Vector3d angular_velocity;
};

/// Equations of motion within one step that begins at R.
class Motion {
 public:
  Motion(const RigidRotor& rotor, const Eigen::Matrix3d& R_begin, const CoilTorque& torque)
      : rotor_(rotor), inverse_(rotor.inertia.inverse()), R_begin_(R_begin), torque_(torque) {}

  Rate rate(const Eigen::Vector3d& rotation, const Eigen::Vector3d& angular_velocity) const {
    const Eigen::Matrix3d R = R_begin_ * rotationExp(rotation);
    const Eigen::Vector3d total = torque_(R) + gravityTorque(rotor_, R) -
                                  angular_velocity.cross(rotor_.inertia * angular_velocity);
    // A velocity in the rotor frame moves the rotation vector by the inverse of its right Jacobian.
    return {leftJacobianInverse(-rotation) * angular_velocity, inverse_ * total};
  }

 private:
  const RigidRotor& rotor_;
  Eigen::Matrix3d inverse_;
  const Eigen::Matrix3d& R_begin_;
  const CoilTorque& torque_;
};

}  // namespace

void validate(const RigidRotor& rotor) {
  if (!rotor.inertia.allFinite() || !rotor.inertia.isApprox(rotor.inertia.transpose(), 1e-9)) {
    throw ConfigError("rotor inertia: it must be finite and symmetric [kg m²].");
  }
  const Eigen::Vector3d principal = symmetricEigenvalues(rotor.inertia);
  constexpr double kRounding = 1.0 + 1e-9;
  if (principal[0] <= 0.0 || principal[2] > (principal[0] + principal[1]) * kRounding) {
    throw ConfigError(
        "rotor inertia: no body has these principal moments; each must be positive, and no larger "
        "than the sum of the two others.");
  }
  if (!rotor.unbalance.allFinite()) {
    throw ConfigError("rotor unbalance: it must be finite [N m].");
  }
}

Eigen::Vector3d gravityDirection(const Eigen::Matrix3d& R_stator_rotor) {
  return -R_stator_rotor.row(2).transpose();
}

Eigen::Vector3d gravityTorque(const RigidRotor& rotor, const Eigen::Matrix3d& R_stator_rotor) {
  return rotor.unbalance.cross(gravityDirection(R_stator_rotor));
}

RotorState advance(const RigidRotor& rotor,
                   const RotorState& state,
                   const CoilTorque& torque,
                   double step) {
  const Motion motion(rotor, state.R_stator_rotor, torque);
  const Eigen::Vector3d& w = state.angular_velocity;
  const Rate k1 = motion.rate(Eigen::Vector3d::Zero(), w);
  const Rate k2 = motion.rate(0.5 * step * k1.rotation, w + 0.5 * step * k1.angular_velocity);
  const Rate k3 = motion.rate(0.5 * step * k2.rotation, w + 0.5 * step * k2.angular_velocity);
  const Rate k4 = motion.rate(step * k3.rotation, w + step * k3.angular_velocity);
  const Eigen::Vector3d rotation =
      step / 6.0 * (k1.rotation + 2.0 * k2.rotation + 2.0 * k3.rotation + k4.rotation);
  const Eigen::Vector3d change = step / 6.0 *
                                 (k1.angular_velocity + 2.0 * k2.angular_velocity +
                                  2.0 * k3.angular_velocity + k4.angular_velocity);
  // Products of many rotations drift off the manifold by rounding.
  const Eigen::Quaterniond turned(state.R_stator_rotor * rotationExp(rotation));
  return {turned.normalized().toRotationMatrix(), w + change};
}

}  // namespace sac
