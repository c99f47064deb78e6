#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sac {

/// How far the norm of a unit quaternion or axis may be from 1 where it was written down or
/// measured: further off it is wrong, not just rounded.
inline constexpr double kUnitTolerance = 1e-3;

/// Whether a quaternion has norm 1 within kUnitTolerance; false for what is not finite.
bool isUnit(const Eigen::Quaterniond& q);

/// Cross-product matrix: `skew(v) * w == v.cross(w)`.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Exponential map of SO(3), e^{v̂}: rotation by ‖v‖ [rad] about v. Defined for every finite v.
Eigen::Matrix3d rotationExp(const Eigen::Vector3d& v);

/// Logarithm of SO(3), the rotation vector ln(R)^∨ [rad] with norm in [0, π]. `R` must be a
/// rotation matrix. At an angle of exactly π either of the two signs may be returned.
Eigen::Vector3d rotationLog(const Eigen::Matrix3d& R);

/// Left Jacobian J_l(v) of SO(3): e^{(v+δ)^} ≈ e^{(J_l(v) δ)^} e^{v̂} (doc/method.md, Joint).
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& v);

/// Inverse of leftJacobian(v), for ‖v‖ < 2π.
Eigen::Matrix3d leftJacobianInverse(const Eigen::Vector3d& v);

}  // namespace sac
