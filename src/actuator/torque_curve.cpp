#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

double radiansPerUnit(AngleUnit unit) {
  return unit == AngleUnit::kDegree ? kPi / 180.0 : 1.0;
}

}  // namespace

void validate(const TorqueCurveDescription& description) {
  if (description.coefficients.empty()) {
    throw ConfigError("torque_curve.coefficients: at least one coefficient is needed.");
  }
  if (!std::all_of(description.coefficients.begin(), description.coefficients.end(), [](double c) {
        return std::isfinite(c);
      })) {
    throw ConfigError("torque_curve.coefficients: every coefficient must be finite.");
  }
  const double scale = radiansPerUnit(description.angle_unit);
  const bool ordered =
      0.0 < description.blend_start && description.blend_start < description.support_begin &&
      description.support_begin < description.support_end && description.support_end * scale < kPi;
  if (!ordered) {
    throw ConfigError(
        "torque_curve: angles must satisfy 0 < blend_start < support[0] < support[1] < 180 deg.");
  }
}

TorqueCurve::TorqueCurve(const TorqueCurveDescription& description) : description_(description) {
  validate(description);
  const double scale = radiansPerUnit(description.angle_unit);
  blend_start_ = description.blend_start * scale;
  support_begin_ = description.support_begin * scale;
  support_end_ = description.support_end * scale;
  cos_support_end_ = std::cos(support_end_);
  coefficients_ = description.coefficients;
  double unit_power = 1.0;
  for (double& coefficient : coefficients_) {
    coefficient /= unit_power;
    unit_power *= scale;
  }
  // k₁ψ + k₃ψ³ meets value and slope of the polynomial at the blend angle b.
  const double b = blend_start_;
  k3_ = (polynomialDerivative(b) * b - polynomial(b)) / (2.0 * b * b * b);
  k1_ = polynomial(b) / b - k3_ * b * b;
  edge_value_ = polynomial(support_begin_);
  edge_slope_ = polynomialDerivative(support_begin_);
}

double TorqueCurve::polynomial(double psi) const {
  double value = 0.0;
  for (auto c = coefficients_.rbegin(); c != coefficients_.rend(); ++c) {
    value = value * psi + *c;
  }
  return value;
}

double TorqueCurve::polynomialDerivative(double psi) const {
  double value = 0.0;
  for (std::size_t n = coefficients_.size() - 1; n > 0; --n) {
    value = value * psi + static_cast<double>(n) * coefficients_[n];
  }
  return value;
}

double TorqueCurve::value(double psi) const {
  if (psi < blend_start_) {
    return psi * (k1_ + k3_ * psi * psi);
  }
  if (psi <= support_begin_) {
    return polynomial(psi);
  }
  if (psi >= support_end_) {
    return 0.0;
  }
  const double width = support_end_ - support_begin_;
  const double t = (psi - support_begin_) / width;
  return (1.0 - t) * (1.0 - t) * (edge_value_ * (1.0 + 2.0 * t) + edge_slope_ * width * t);
}

double TorqueCurve::derivative(double psi) const {
  if (psi < blend_start_) {
    return k1_ + 3.0 * k3_ * psi * psi;
  }
  if (psi <= support_begin_) {
    return polynomialDerivative(psi);
  }
  if (psi >= support_end_) {
    return 0.0;
  }
  const double width = support_end_ - support_begin_;
  const double t = (psi - support_begin_) / width;
  return (1.0 - t) * (edge_slope_ * (1.0 - 3.0 * t) - 6.0 * edge_value_ * t / width);
}

TorqueCurve::Safe TorqueCurve::safe(double kappa, double sin_psi) const {
  if (kappa <= cos_support_end_) {
    return {};
  }
  // atan2 keeps full precision at small angles, where acos(κ) has lost half of the digits.
  const double psi = std::atan2(sin_psi, kappa);
  constexpr double kSeriesAngle = 1e-3;
  if (psi < std::min(kSeriesAngle, blend_start_)) {
    // Series of (k₁ψ + k₃ψ³)/sin ψ and of its derivative by κ = cos ψ in ψ²; error below 1e-12.
    const double p2 = psi * psi;
    const double order_2 = k3_ + k1_ / 6.0;
    const double order_4 = k3_ / 6.0 + 7.0 * k1_ / 360.0;
    return {k1_ + p2 * (order_2 + p2 * order_4),
            -2.0 * order_2 - p2 * (order_2 / 3.0 + 4.0 * order_4)};
  }
  const double f = value(psi);
  const double df = derivative(psi);
  const double inverse_sine = 1.0 / sin_psi;
  return {f * inverse_sine,
          -(df * sin_psi - f * kappa) * inverse_sine * inverse_sine * inverse_sine};
}

}  // namespace sac
