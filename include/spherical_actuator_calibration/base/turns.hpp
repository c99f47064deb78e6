#pragma once

#include <cmath>

#include <Eigen/Core>

namespace sac {

/// Turns about x, then y, then z that make a rotation matrix, exactly: the second within ±π/2, the
/// others within ±π [rad]. Where the second is ±π/2 only the sum or difference of the others is
/// determined.
inline Eigen::Vector3d turnsOf(const Eigen::Matrix3d& R) {
  const double first = std::atan2(-R(1, 2), R(2, 2));
  // Of R with the first turn taken back the second row is (sin q₃, cos q₃, 0) whatever that turn is
  // made of: near q₂ = ±π/2 that is rounding errors.
  const Eigen::RowVector3d row = std::cos(first) * R.row(1) + std::sin(first) * R.row(2);
  return {first, std::atan2(R(0, 2), std::hypot(R(1, 2), R(2, 2))), std::atan2(row[0], row[1])};
}

}  // namespace sac
