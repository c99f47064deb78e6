#pragma once

#include <array>
#include <memory>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// Unit axes and offsets of the three joints in the form that the kinematics needs.
struct JointGeometry {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< column k: unit axis ω_k
  Eigen::Vector3d offsets = Eigen::Vector3d::Zero();   ///< δq_k [rad]
  /// Per joint, of the readings (ReadingCorrection); nothing where all of them are zero.
  std::array<ReadingCorrection, kJoints> corrections = {};
  bool is_corrected = false;
  std::shared_ptr<const OrientationMap> map = nullptr;  ///< null: none
};

/// Geometry of a description's joints, without an orientation map.
JointGeometry jointGeometry(const std::array<JointAxis, kJoints>& joints);
/// The same with the orientation map: everything that a description says of the orientation.
JointGeometry jointGeometry(const Actuator& actuator);

/// Joint angles before offsets at raw sensor angles [rad]: the readings with their corrections.
Eigen::Vector3d correctedReading(const JointGeometry& joints, const Eigen::Vector3d& reading);

/// Rotor orientation R_stator_rotor at raw joint sensor angles `q` [rad]: the product of
/// exponentials of paper (1), with corrected readings, turned by the map where there is one.
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

/// Linearises rotorOrientation() at `q` [rad] (doc/method.md, Joint (8), (12–14)). Corrections and
/// map count as constant: their slopes are a thousandth.
JointLinearization linearizeRotorOrientation(const JointGeometry& joints, const Eigen::Vector3d& q);

}  // namespace sac
