#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"

#include <cmath>

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
    const double length = axis.norm();
    const Eigen::Vector3d unit = axis / length;
    const double turn = (q[k] + joints.offsets[k]) * length;
    const double sine = std::sin(turn);
    const double cosine = std::cos(turn);
    const Eigen::Matrix3d cross = skew(unit);
    const Eigen::Matrix3d along = unit * unit.transpose();
    linear.d_offset.col(k) = A * axis;
    // Angle times J_l, which has no quotient that small angles would spoil.
    Eigen::Matrix3d d_axis = (1.0 - cosine) * cross + (turn - sine) * along;
    d_axis.diagonal().array() += sine;
    linear.d_axis[static_cast<std::size_t>(k)].noalias() = A * (d_axis / length);
    Eigen::Matrix3d R = sine * cross + (1.0 - cosine) * along;
    R.diagonal().array() += cosine;
    A = (A * R).eval();
  }
  linear.R_stator_rotor = A;
  return linear;
}

}  // namespace sac
