#pragma once

#include <Eigen/Core>

namespace sac {

/// Minimal coordinates of a unit axis: normal coordinates (u, v) [rad] of the sphere S² around a
/// base axis n, axis(u, v) = cos ρ n + sin ρ (u e_u + v e_v)/ρ with ρ = √(u² + v²). Regular for ρ <
/// π.
///
/// Estimation moves on the manifold of unit vectors in these coordinates: they have a fixed meaning
/// (so a parameter has a name, a prior and a standard deviation) and can be held one by one.
/// Invariant: (n, e_u, e_v) is a right-handed orthonormal triad.
class AxisChart {
 public:
  /// Chart of a joint axis. e_u is the projection of the coordinate axis that follows (cyclically)
  /// the largest component of the base: for base x, (e_u, e_v) = (y, z); for y, (z, x); for z, (x,
  /// y).
  static AxisChart aroundAxis(const Eigen::Vector3d& base);

  /// Chart of a pole or coil axis given by elevation and azimuth [rad]: e_u points to growing
  /// elevation, e_v to growing azimuth, so u ≈ δpolar and v ≈ cos(polar) δazimuth. Regular also at
  /// polar = ±π/2.
  static AxisChart aroundAngles(double polar, double azimuth);

  /// Unit axis at the coordinates.
  Eigen::Vector3d axis(double u, double v) const;

  /// ∂axis/∂(u, v), 3×2.
  Eigen::Matrix<double, 3, 2> jacobian(double u, double v) const;

  /// Axis and ∂axis/∂(u, v) in one evaluation.
  void evaluate(double u, double v, Eigen::Vector3d& axis, Eigen::Matrix<double, 3, 2>& jac) const;

  /// Coordinates of a unit axis: inverse of axis(), for axes within less than π of the base.
  Eigen::Vector2d coordinates(const Eigen::Vector3d& axis) const;

  const Eigen::Vector3d& base() const { return base_; }
  const Eigen::Vector3d& basisU() const { return e_u_; }
  const Eigen::Vector3d& basisV() const { return e_v_; }

 private:
  AxisChart(const Eigen::Vector3d& base, const Eigen::Vector3d& e_u, const Eigen::Vector3d& e_v)
      : base_(base), e_u_(e_u), e_v_(e_v) {}

  Eigen::Vector3d base_;
  Eigen::Vector3d e_u_;
  Eigen::Vector3d e_v_;
};

}  // namespace sac
