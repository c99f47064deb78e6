#pragma once

#include <Eigen/Core>

namespace sac {

/// The momentum of an interval, and how it changes with the turns of both readings.
struct IntervalMomentum {
  Eigen::Vector3d turn;      ///< Δ [rad]
  Eigen::Vector3d momentum;  ///< A Δ [N·m·s·s]
  // ∂/∂ξ of the readings after and before.
  Eigen::Matrix3d turn_after;
  Eigen::Matrix3d turn_before;
  Eigen::Matrix3d momentum_after;
  Eigen::Matrix3d momentum_before;
  Eigen::Matrix<double, 3, 6> d_inertia;

  /// Of the rotor's orientations at both readings, R_stator_rotor, and its inertia, rotor frame.
  IntervalMomentum(const Eigen::Matrix3d& before,
                   const Eigen::Matrix3d& after,
                   const Eigen::Matrix3d& inertia);
};

}  // namespace sac
