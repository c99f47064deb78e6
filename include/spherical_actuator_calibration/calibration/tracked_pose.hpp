#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace sac {

/// The tracker's raw pose while the rotor rested.
struct TrackedPose {
  std::uint32_t id = 0;
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles [rad]
  Eigen::Vector3d joint_stddev = Eigen::Vector3d::Zero();    ///< of the mean [rad]
  Eigen::Matrix3d R_tracker_marker = Eigen::Matrix3d::Identity();
  double orientation_stddev = 0.0;  ///< of the mean, per component [rad]; 0: not stated
};

/// One pose after the registration.
struct RegisteredPose {
  std::uint32_t id = 0;
  /// ln of measured times predicted orientation transposed, stator frame [rad].
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  double standardized = 0.0;  ///< Mahalanobis norm over √3; about 1 when it fits
  bool rejected = false;
};

/// Of small turns ξ of the tracker in stator axes and ζ of the marker in rotor axes: the true
/// frames are e^{ξ̂} R_stator_tracker and e^{ζ̂} R_rotor_marker [rad²].
using FrameCovariance = Eigen::Matrix<double, 6, 6>;

}  // namespace sac
