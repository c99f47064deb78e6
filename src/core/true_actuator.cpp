#include "spherical_actuator_calibration/core/true_actuator.hpp"

#include <Eigen/Geometry>

namespace spherical_actuator_calibration {
namespace {

/// Direction of gravity in the rotor frame.
Eigen::Vector3d down(const Eigen::Matrix3d& R_stator_rotor) {
  return -R_stator_rotor.row(2).transpose();
}

}  // namespace

TrueActuator::TrueActuator(const Actuator& truth, const RotorLoad& load)
    : joints_(jointGeometry(truth.joints)), torques_(torqueGeometry(truth)), load_(load) {
  validate(truth);
  if (truth.hasTorqueModel()) {
    curve_.emplace(*truth.torque_curve);
  }
}

Eigen::Matrix3d TrueActuator::orientation(const Eigen::Vector3d& q) const {
  return rotorOrientation(joints_, q);
}

Eigen::Vector3d TrueActuator::weight(const Eigen::Matrix3d& R_stator_rotor) const {
  return load_.weight * down(R_stator_rotor);
}

Eigen::Vector3d TrueActuator::torque(const Eigen::Matrix3d& R_stator_rotor,
                                     const Eigen::VectorXd& currents) const {
  return rotorTorque(*curve_, torques_, R_stator_rotor, currents) +
         load_.unbalance.cross(down(R_stator_rotor));
}

}  // namespace spherical_actuator_calibration
