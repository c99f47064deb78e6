#include "spherical_actuator_calibration/emulation/free_rotor.hpp"

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

const Actuator& withTorqueModel(const Actuator& truth) {
  validate(truth);
  if (!truth.hasTorqueModel()) {
    throw ConfigError("A rotor without poles, coils and torque curve does not move by itself.");
  }
  return truth;
}

}  // namespace

FreeRotor::FreeRotor(const Actuator& truth,
                     const RigidRotor& rotor,
                     double stop_tilt,
                     const BearingFriction& friction)
    : joints_(jointGeometry(withTorqueModel(truth))),
      torques_(torqueGeometry(truth)),
      curve_(*truth.torque_curve),
      rotor_(rotor),
      stop_tilt_(stop_tilt),
      friction_(friction) {
  validate(rotor);
  validate(friction);
  requireInRange("mechanical_stop", stop_tilt, ValueRange::open(0.0, kGimbalLock, "rad"));
  release(q_);
}

void FreeRotor::release(const Eigen::Vector3d& q) {
  q_ = q;
  state_.R_stator_rotor = rotorOrientation(joints_, q);
  state_.angular_velocity.setZero();
  is_at_stop_ = false;
}

// Friction knows the velocity alone, the other torques the orientation: each has its turn, friction
// half of it before and half after, which keeps the second order.
void FreeRotor::advance(double step,
                        const Eigen::VectorXd& currents,
                        const Eigen::Vector3d& push_stator) {
  state_.angular_velocity =
      slowedBy(friction_, rotor_.inertia, state_.angular_velocity, 0.5 * step);
  RotorState next = sac::advance(
      rotor_,
      state_,
      [&](const Eigen::Matrix3d& R) {
        return (rotorTorque(curve_, torques_, R, currents) + R.transpose() * push_stator).eval();
      },
      step);
  next.angular_velocity = slowedBy(friction_, rotor_.inertia, next.angular_velocity, 0.5 * step);
  const auto q = jointAngles(joints_, next.R_stator_rotor, q_);
  is_at_stop_ = !q || q->head<2>().cwiseAbs().maxCoeff() > stop_tilt_;
  if (is_at_stop_) {
    state_.angular_velocity.setZero();
    return;
  }
  q_ = *q;
  state_ = next;
}

}  // namespace sac
