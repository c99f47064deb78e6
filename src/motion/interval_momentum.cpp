#include "interval_momentum.hpp"

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// ∂(J u)/∂(xx, yy, zz, xy, xz, yz) of a symmetric J.
Eigen::Matrix<double, 3, 6> inertiaColumns(const Eigen::Vector3d& u) {
  Eigen::Matrix<double, 3, 6> columns;
  columns << u[0], 0.0, 0.0, u[1], u[2], 0.0,  //
      0.0, u[1], 0.0, u[0], 0.0, u[2],         //
      0.0, 0.0, u[2], 0.0, u[0], u[1];
  return columns;
}

}  // namespace

IntervalMomentum::IntervalMomentum(const Eigen::Matrix3d& before,
                                   const Eigen::Matrix3d& after,
                                   const Eigen::Matrix3d& inertia)
    : turn(rotationLog(after * before.transpose())) {
  const Eigen::Matrix3d R_half = rotationExp(0.5 * turn);
  const Eigen::Matrix3d R_middle = R_half * before;
  const Eigen::Matrix3d A = R_middle * inertia * R_middle.transpose();
  momentum = A * turn;
  turn_after = leftJacobianInverse(turn);
  turn_before = -turn_after * (R_half * R_half);
  const Eigen::Matrix3d half_left = 0.5 * leftJacobian(0.5 * turn);
  const Eigen::Matrix3d by_middle = A * skew(turn) - skew(momentum);
  momentum_after = A * turn_after + by_middle * half_left * turn_after;
  momentum_before = A * turn_before + by_middle * (half_left * turn_before + R_half);
  d_inertia = R_middle * inertiaColumns(R_middle.transpose() * turn);
}

}  // namespace sac
