#include "spherical_actuator_calibration/emulation/true_actuator.hpp"

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"

namespace sac {

TrueActuator::TrueActuator(const Actuator& truth, const RotorLoad& load)
    : joints_(jointGeometry(truth)), torques_(torqueGeometry(truth)), load_(load) {
  validate(truth);
  if (truth.hasTorqueModel()) {
    curve_.emplace(*truth.torque_curve);
  }
}

Eigen::Matrix3d TrueActuator::orientation(const Eigen::Vector3d& q) const {
  return rotorOrientation(joints_, q);
}

Eigen::Vector3d TrueActuator::weight(const Eigen::Matrix3d& R_stator_rotor) const {
  return load_.weight * gravityDirection(R_stator_rotor);
}

Eigen::Vector3d TrueActuator::torque(const Eigen::Matrix3d& R_stator_rotor,
                                     const Eigen::VectorXd& currents) const {
  return rotorTorque(*curve_, torques_, R_stator_rotor, currents) +
         load_.unbalance.cross(gravityDirection(R_stator_rotor));
}

}  // namespace sac
