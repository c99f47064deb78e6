#pragma once

#include <array>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// Unit axes and offsets of the three joints in the form that the kinematics needs.
struct JointGeometry {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< column k: unit axis ω_k
  Eigen::Vector3d offsets = Eigen::Vector3d::Zero();   ///< δq_k [rad]
};

/// Geometry of a description's joints.
JointGeometry jointGeometry(const std::array<JointAxis, kJoints>& joints);

/// Rotor orientation R_stator_rotor at raw joint sensor angles `q` [rad]: the product of
/// exponentials of paper (1).
Eigen::Matrix3d rotorOrientation(const JointGeometry& joints, const Eigen::Vector3d& q);

/// Rotor orientation and how it moves. ξ is the left rotation error in the stator frame: R →
/// e^{ξ̂}R.
struct JointLinearization {
  Eigen::Matrix3d R_stator_rotor;
  /// Column k: ∂ξ/∂δq_k = ∂ξ/∂q_k = A_k ω_k (doc/method.md, Joint (12–14)).
  Eigen::Matrix3d d_offset;
  /// ∂ξ/∂ω_k = q_k A_k J_l(ω_k q_k), q_k with its offset.
  std::array<Eigen::Matrix3d, kJoints> d_axis;
};

/// Linearises rotorOrientation() at `q` [rad] (doc/method.md, Joint (8), (12–14)).
JointLinearization linearizeRotorOrientation(const JointGeometry& joints, const Eigen::Vector3d& q);

}  // namespace sac
