#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// Rotation about one joint, e^{ω̂q}, and how ω acts on it, without quotients that small angles
/// would spoil.
class Turn {
 public:
  Turn(const Eigen::Vector3d& axis, double angle)
      : length_(axis.norm()),
        axis_(axis / length_),
        angle_(angle * length_),
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

template <typename Values>
bool areZero(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
}

}  // namespace

JointGeometry jointGeometry(const std::array<JointAxis, kJoints>& joints) {
  JointGeometry geometry;
  for (std::size_t k = 0; k < kJoints; ++k) {
    geometry.axes.col(static_cast<Eigen::Index>(k)) = joints[k].axis;
    geometry.offsets[static_cast<Eigen::Index>(k)] = joints[k].offset;
    geometry.corrections[k] = joints[k].correction;
    geometry.is_corrected = geometry.is_corrected || !areZero(joints[k].correction.linear) ||
                            !areZero(joints[k].correction.harmonics);
  }
  return geometry;
}

JointGeometry jointGeometry(const Actuator& actuator) {
  JointGeometry geometry = jointGeometry(actuator.joints);
  geometry.map = actuator.orientation_map;
  return geometry;
}

Eigen::Vector3d correctedReading(const JointGeometry& joints, const Eigen::Vector3d& reading) {
  Eigen::Vector3d corrected = reading;
  for (std::size_t k = 0; joints.is_corrected && k < kJoints; ++k) {
    const auto& [linear, harmonics] = joints.corrections[k];
    const auto joint = static_cast<Eigen::Index>(k);
    const double q = reading[joint];
    corrected[joint] += linear[0] * reading[0] + linear[1] * reading[1] + linear[2] * reading[2] +
                        harmonics[0] * std::cos(q) + harmonics[1] * std::sin(q) +
                        harmonics[2] * std::cos(2.0 * q) + harmonics[3] * std::sin(2.0 * q);
  }
  return corrected;
}

Eigen::Matrix3d rotorOrientation(const JointGeometry& joints, const Eigen::Vector3d& q) {
  const Eigen::Vector3d angles = correctedReading(joints, q) + joints.offsets;
  const Eigen::Matrix3d R = Turn(joints.axes.col(0), angles[0]).rotation() *
                            Turn(joints.axes.col(1), angles[1]).rotation() *
                            Turn(joints.axes.col(2), angles[2]).rotation();
  return joints.map ? Eigen::Matrix3d(rotationExp(joints.map->mean(q)) * R) : R;
}

JointLinearization linearizeRotorOrientation(const JointGeometry& joints,
                                             const Eigen::Vector3d& q) {
  JointLinearization linear;
  const Eigen::Vector3d angles = correctedReading(joints, q) + joints.offsets;
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  if (joints.map) {
    A = rotationExp(joints.map->mean(q));  // a rotation from the left turns ξ as it turns R
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Turn turn(joints.axes.col(k), angles[k]);
    linear.d_offset.col(k) = A * joints.axes.col(k);
    linear.d_axis[static_cast<std::size_t>(k)].noalias() = A * turn.jacobian();
    A = (A * turn.rotation()).eval();
  }
  linear.R_stator_rotor = A;
  return linear;
}

}  // namespace sac
