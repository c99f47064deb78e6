#include "spherical_actuator_calibration/control/computed_torque_control.hpp"

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {

void validate(const ControlGains& gains) {
  requireInRange("proportional gain", gains.proportional, ValueRange::positive("1/s²"));
  requireInRange("derivative gain", gains.derivative, ValueRange::positive("1/s"));
}

const Actuator& controllable(const Actuator& actuator) {
  validate(actuator);
  if (!actuator.hasTorqueModel()) {
    throw ConfigError("An actuator without poles, coils and torque curve cannot be controlled.");
  }
  return actuator;
}

Eigen::Vector3d computedTorque(const RigidRotor& rotor,
                               const RotorState& state,
                               const DesiredMotion& desired,
                               const ControlGains& gains) {
  const Eigen::Matrix3d R_rotor_desired = state.R_stator_rotor.transpose() * desired.R_stator_rotor;
  const Eigen::Vector3d& w = state.angular_velocity;
  const Eigen::Vector3d acceleration =
      R_rotor_desired * desired.angular_acceleration +
      gains.proportional * rotationLog(R_rotor_desired) +
      gains.derivative * (R_rotor_desired * desired.angular_velocity - w);
  return rotor.inertia * acceleration + w.cross(rotor.inertia * w) -
         gravityTorque(rotor, state.R_stator_rotor);
}

Eigen::Matrix3d orientationForTorque(const RigidRotor& rotor,
                                     const RotorState& state,
                                     const DesiredMotion& desired,
                                     const Eigen::Vector3d& torque,
                                     const ControlGains& gains) {
  // Beside the rotation's own part, velocity and acceleration depend on it weakly.
  constexpr int kRounds = 5;
  const Cholesky3 inertia(rotor.inertia);
  DesiredMotion motion = desired;
  motion.R_stator_rotor = state.R_stator_rotor;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Vector3d rest = torque - computedTorque(rotor, state, motion, gains);
    motion.R_stator_rotor *= rotationExp(inertia.solve(rest) / gains.proportional);
  }
  return motion.R_stator_rotor;
}

}  // namespace sac
