#include "spherical_actuator_calibration/core/computed_torque_control.hpp"

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/core/rotations.hpp"
#include "spherical_actuator_calibration/core/value_range.hpp"

namespace spherical_actuator_calibration {

void validate(const ControlGains& gains) {
  requireInRange("proportional gain", gains.proportional, ValueRange::positive("1/s²"));
  requireInRange("derivative gain", gains.derivative, ValueRange::positive("1/s"));
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

}  // namespace spherical_actuator_calibration
