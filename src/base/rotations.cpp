#include "spherical_actuator_calibration/base/rotations.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

/// Below this angle [rad] the closed forms lose digits and the series to θ⁴ are exact to 1e-16.
constexpr double kSmallAngle = 1e-2;

/// Coefficients of I, v̂ and v̂² in the functions of SO(3), as functions of θ = ‖v‖.
struct Coefficients {
  double a;  ///< sinθ/θ
  double b;  ///< (1 − cosθ)/θ²
  double c;  ///< (θ − sinθ)/θ³
};

Coefficients coefficients(double theta_squared) {
  const double t2 = theta_squared;
  if (t2 < kSmallAngle * kSmallAngle) {
    return {1.0 - t2 / 6.0 * (1.0 - t2 / 20.0 * (1.0 - t2 / 42.0)),
            0.5 - t2 / 24.0 * (1.0 - t2 / 30.0 * (1.0 - t2 / 56.0)),
            1.0 / 6.0 - t2 / 120.0 * (1.0 - t2 / 42.0 * (1.0 - t2 / 72.0))};
  }
  const double theta = std::sqrt(t2);
  const double half_sine = std::sin(0.5 * theta);
  const double sine = std::sin(theta);
  return {sine / theta, 2.0 * half_sine * half_sine / t2, (theta - sine) / (t2 * theta)};
}

}  // namespace

bool isUnit(const Eigen::Quaterniond& q) {
  // False also for NaN, and for a norm that overflows.
  return std::abs(q.norm() - 1.0) <= kUnitTolerance;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

Eigen::Matrix3d rotationExp(const Eigen::Vector3d& v) {
  const double theta_squared = v.squaredNorm();
  const Coefficients k = coefficients(theta_squared);
  // v̂² = v vᵀ − θ² I, written out so that no 3×3 product is formed.
  Eigen::Matrix3d R = k.b * v * v.transpose();
  R.diagonal().array() += 1.0 - k.b * theta_squared;
  const Eigen::Vector3d s = k.a * v;
  R(0, 1) -= s.z();
  R(1, 0) += s.z();
  R(0, 2) += s.y();
  R(2, 0) -= s.y();
  R(1, 2) -= s.x();
  R(2, 1) += s.x();
  return R;
}

Eigen::Vector3d rotationLog(const Eigen::Matrix3d& R) {
  // The quaternion keeps full precision at both ends of [0, π], which neither acos nor asin does.
  const Eigen::Quaterniond q(R);
  const double norm = q.vec().norm();
  if (norm < 1e-12) {
    return (q.w() < 0.0 ? -2.0 : 2.0) * q.vec();
  }
  const double angle = 2.0 * (q.w() < 0.0 ? std::atan2(-norm, -q.w()) : std::atan2(norm, q.w()));
  return angle / norm * q.vec();
}

Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& v) {
  const double theta_squared = v.squaredNorm();
  const Coefficients k = coefficients(theta_squared);
  Eigen::Matrix3d J = k.c * v * v.transpose() + k.b * skew(v);
  J.diagonal().array() += 1.0 - k.c * theta_squared;
  return J;
}

Eigen::Matrix3d leftJacobianInverse(const Eigen::Vector3d& v) {
  const double theta_squared = v.squaredNorm();
  const Coefficients k = coefficients(theta_squared);
  // J_l⁻¹ = I − v̂/2 + e v̂², e = (1 − a/(2b))/θ² with the coefficients above.
  const double e = theta_squared < kSmallAngle * kSmallAngle
                       ? 1.0 / 12.0 + theta_squared / 720.0 * (1.0 + theta_squared / 42.0)
                       : (1.0 - k.a / (2.0 * k.b)) / theta_squared;
  Eigen::Matrix3d J = e * v * v.transpose() - 0.5 * skew(v);
  J.diagonal().array() += 1.0 - e * theta_squared;
  return J;
}

}  // namespace sac
