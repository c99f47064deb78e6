#include "spherical_actuator_calibration/base/axis_chart.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace sac {
namespace {

/// sin ρ/ρ and (d/dρ sin ρ/ρ)/ρ for ρ² ≥ 0, by series where the closed form loses digits.
struct Sinc {
  double value;
  double slope_over_rho;
};

Sinc sinc(double rho_squared) {
  constexpr double kSmall = 1e-4;
  if (rho_squared < kSmall) {
    return {1.0 - rho_squared / 6.0 * (1.0 - rho_squared / 20.0 * (1.0 - rho_squared / 42.0)),
            -1.0 / 3.0 + rho_squared / 30.0 * (1.0 - rho_squared / 28.0)};
  }
  const double rho = std::sqrt(rho_squared);
  const double value = std::sin(rho) / rho;
  return {value, (std::cos(rho) - value) / rho_squared};
}

}  // namespace

AxisChart AxisChart::aroundAxis(const Eigen::Vector3d& base) {
  const Eigen::Vector3d n = base.normalized();
  Eigen::Index largest = 0;
  n.cwiseAbs().maxCoeff(&largest);
  const Eigen::Vector3d next = Eigen::Vector3d::Unit((largest + 1) % 3);
  const Eigen::Vector3d e_u = (next - n * n.dot(next)).normalized();
  return {n, e_u, n.cross(e_u)};
}

AxisChart AxisChart::aroundAngles(double polar, double azimuth) {
  const double sin_polar = std::sin(polar);
  const double cos_polar = std::cos(polar);
  const double sin_azimuth = std::sin(azimuth);
  const double cos_azimuth = std::cos(azimuth);
  const Eigen::Vector3d up(-sin_polar * cos_azimuth, -sin_polar * sin_azimuth, cos_polar);
  const Eigen::Vector3d east(-sin_azimuth, cos_azimuth, 0.0);
  const Eigen::Vector3d base(cos_polar * cos_azimuth, cos_polar * sin_azimuth, sin_polar);
  return {base, up, east};
}

Eigen::Vector3d AxisChart::axis(double u, double v) const {
  const double rho_squared = u * u + v * v;
  return std::cos(std::sqrt(rho_squared)) * base_ + sinc(rho_squared).value * (u * e_u_ + v * e_v_);
}

Eigen::Matrix<double, 3, 2> AxisChart::jacobian(double u, double v) const {
  Eigen::Vector3d unused;
  Eigen::Matrix<double, 3, 2> jac;
  evaluate(u, v, unused, jac);
  return jac;
}

void AxisChart::evaluate(double u,
                         double v,
                         Eigen::Vector3d& axis,
                         Eigen::Matrix<double, 3, 2>& jac) const {
  const double rho_squared = u * u + v * v;
  const Sinc s = sinc(rho_squared);
  const Eigen::Vector3d tangent = u * e_u_ + v * e_v_;
  axis = std::cos(std::sqrt(rho_squared)) * base_ + s.value * tangent;
  const Eigen::Vector3d radial = s.slope_over_rho * tangent - s.value * base_;
  jac.col(0) = s.value * e_u_ + u * radial;
  jac.col(1) = s.value * e_v_ + v * radial;
}

Eigen::Vector2d AxisChart::coordinates(const Eigen::Vector3d& axis) const {
  const Eigen::Vector2d tangent(e_u_.dot(axis), e_v_.dot(axis));
  const double sine = tangent.norm();
  const double rho = std::atan2(sine, base_.dot(axis));
  return sine > 0.0 ? Eigen::Vector2d(tangent * (rho / sine)) : Eigen::Vector2d::Zero();
}

}  // namespace sac
