#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {

JointGeometry jointGeometry(const std::array<JointAxis, kJoints>& joints) {
  JointGeometry geometry;
  for (std::size_t k = 0; k < kJoints; ++k) {
    geometry.axes.col(static_cast<Eigen::Index>(k)) = joints[k].axis;
    geometry.offsets[static_cast<Eigen::Index>(k)] = joints[k].offset;
  }
  return geometry;
}

Eigen::Matrix3d rotorOrientation(const JointGeometry& joints, const Eigen::Vector3d& q) {
  const Eigen::Vector3d angle = q + joints.offsets;
  return rotationExp(joints.axes.col(0) * angle[0]) * rotationExp(joints.axes.col(1) * angle[1]) *
         rotationExp(joints.axes.col(2) * angle[2]);
}

JointLinearization linearizeRotorOrientation(const JointGeometry& joints,
                                             const Eigen::Vector3d& q) {
  JointLinearization linear;
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = joints.axes.col(k);
    const double angle = q[k] + joints.offsets[k];
    const Eigen::Vector3d v = axis * angle;
    linear.d_offset.col(k) = A * axis;
    linear.d_axis[static_cast<std::size_t>(k)] = angle * A * leftJacobian(v);
    A = A * rotationExp(v);
  }
  linear.R_stator_rotor = A;
  return linear;
}

}  // namespace sac
