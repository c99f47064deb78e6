#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// Rotation about one joint, e^{ω̂q}, and how ω acts on it, without quotients that small angles
/// would spoil.
class Turn {
 public:
  Turn(const JointGeometry& joints, const Eigen::Vector3d& q, Eigen::Index k)
      : length_(joints.axes.col(k).norm()),
        axis_(joints.axes.col(k) / length_),
        angle_((q[k] + joints.offsets[k]) * length_),
        sine_(std::sin(angle_)),
        cosine_(std::cos(angle_)) {}

  Eigen::Matrix3d rotation() const { return combined(cosine_, sine_, 1.0 - cosine_); }
  /// q J_l(ωq).
  Eigen::Matrix3d jacobian() const {
    return combined(sine_, 1.0 - cosine_, angle_ - sine_) / length_;
  }

 private:
  /// a I + b ω̂ + c ωωᵀ for the unit vector ω.
  Eigen::Matrix3d combined(double a, double b, double c) const {
    Eigen::Matrix3d sum = c * axis_ * axis_.transpose() + b * skew(axis_);
    sum.diagonal().array() += a;
    return sum;
  }

  double length_;
  Eigen::Vector3d axis_;
  double angle_;
  double sine_;
  double cosine_;
};

}  // namespace

JointGeometry jointGeometry(const std::array<JointAxis, kJoints>& joints) {
  JointGeometry geometry;
  for (std::size_t k = 0; k < kJoints; ++k) {
    geometry.axes.col(static_cast<Eigen::Index>(k)) = joints[k].axis;
    geometry.offsets[static_cast<Eigen::Index>(k)] = joints[k].offset;
  }
  return geometry;
}

Eigen::Matrix3d rotorOrientation(const JointGeometry& joints, const Eigen::Vector3d& q) {
  return Turn(joints, q, 0).rotation() * Turn(joints, q, 1).rotation() *
         Turn(joints, q, 2).rotation();
}

JointLinearization linearizeRotorOrientation(const JointGeometry& joints,
                                             const Eigen::Vector3d& q) {
  JointLinearization linear;
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Turn turn(joints, q, k);
    linear.d_offset.col(k) = A * joints.axes.col(k);
    linear.d_axis[static_cast<std::size_t>(k)].noalias() = A * turn.jacobian();
    A = (A * turn.rotation()).eval();
  }
  linear.R_stator_rotor = A;
  return linear;
}

}  // namespace sac
