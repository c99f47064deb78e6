#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kDegree = kPi / 180.0;

TorqueCurveDescription paperCurve() {
  return *scenarios::paperNominal().torque_curve;
}

/// The paper's polynomial, ψ in degrees.
double paperPolynomial(double degrees) {
  double value = 0.0;
  double power = 1.0;
  for (const double c : paperCurve().coefficients) {
    value += c * power;
    power *= degrees;
  }
  return value;
}

TEST(TorqueCurve, IsThePolynomialOnItsSupport) {
  const TorqueCurve curve(paperCurve());
  for (double degrees = 2.0; degrees <= 28.0; degrees += 0.5) {
    EXPECT_NEAR(curve.value(degrees * kDegree), paperPolynomial(degrees), 1e-14);
  }
  EXPECT_NEAR(curve.value(10.0 * kDegree), 0.2843, 1e-4);  // peak of the published curve
}

TEST(TorqueCurve, HasThePublishedCoefficientsNearZero) {
  const TorqueCurve curve(paperCurve());
  EXPECT_NEAR(curve.linearCoefficient(), 2.73064, 1e-5);
  EXPECT_NEAR(curve.cubicCoefficient(), -2.95545, 1e-5);
}

TEST(TorqueCurve, StaysCloseToThePolynomialWhereItLeavesIt) {
  const TorqueCurve curve(paperCurve());
  for (double degrees = 0.0; degrees < 2.0; degrees += 0.01) {
    EXPECT_LE(std::abs(curve.value(degrees * kDegree) - paperPolynomial(degrees)), 5.4e-3);
  }
  for (double degrees = 28.0; degrees < 29.93; degrees += 0.01) {
    EXPECT_LE(std::abs(curve.value(degrees * kDegree) - paperPolynomial(degrees)), 1.65e-3);
  }
}

TEST(TorqueCurve, IsContinuousWithItsSlopeAtEveryBlend) {
  const TorqueCurve curve(paperCurve());
  for (const double degrees : {2.0, 28.0, 32.0}) {
    const double below = (degrees - 1e-9) * kDegree;
    const double above = (degrees + 1e-9) * kDegree;
    EXPECT_NEAR(curve.value(below), curve.value(above), 1e-9) << degrees;
    EXPECT_NEAR(curve.derivative(below), curve.derivative(above), 1e-7) << degrees;
  }
}

TEST(TorqueCurve, IsZeroBeyondItsSupport) {
  const TorqueCurve curve(paperCurve());
  for (const double degrees : {32.0, 33.0, 60.0, 179.0}) {
    EXPECT_EQ(curve.value(degrees * kDegree), 0.0);
    EXPECT_EQ(curve.derivative(degrees * kDegree), 0.0);
  }
}

TEST(TorqueCurve, DerivativeIsTheSlopeOfTheValue) {
  const TorqueCurve curve(paperCurve());
  for (double degrees = 0.5; degrees < 34.0; degrees += 0.97) {
    const double psi = degrees * kDegree;
    const double step = 1e-6;
    const double slope = (curve.value(psi + step) - curve.value(psi - step)) / (2.0 * step);
    EXPECT_NEAR(curve.derivative(psi), slope, 1e-7) << degrees;
  }
}

TEST(TorqueCurve, SafeFormIsValueOverSineAndItsSlope) {
  const TorqueCurve curve(paperCurve());
  const auto h = [&](double kappa) {
    return curve.value(std::acos(kappa)) / std::sin(std::acos(kappa));
  };
  for (double degrees = 1.0; degrees < 34.0; degrees += 0.83) {
    const double kappa = std::cos(degrees * kDegree);
    const TorqueCurve::Safe safe = curve.safe(kappa, std::sin(degrees * kDegree));
    EXPECT_NEAR(safe.h, h(kappa), 1e-12) << degrees;
    const double step = 1e-7;
    EXPECT_NEAR(safe.dh, (h(kappa + step) - h(kappa - step)) / (2.0 * step), 1e-5) << degrees;
  }
}

TEST(TorqueCurve, SafeFormHasItsLimitsAtZeroAngle) {
  const TorqueCurve curve(paperCurve());
  const double k1 = curve.linearCoefficient();
  const double k3 = curve.cubicCoefficient();
  const TorqueCurve::Safe at_zero = curve.safe(1.0, 0.0);
  EXPECT_DOUBLE_EQ(at_zero.h, k1);
  EXPECT_NEAR(at_zero.dh, -(k1 / 3.0 + 2.0 * k3), 1e-13);
  // No step where the series hands over to the closed form.
  const TorqueCurve::Safe below = curve.safe(std::cos(0.999999e-3), std::sin(0.999999e-3));
  const TorqueCurve::Safe above = curve.safe(std::cos(1.000001e-3), std::sin(1.000001e-3));
  EXPECT_NEAR(below.h, above.h, 1e-10);
  EXPECT_NEAR(below.dh, above.dh, 1e-7);
}

TEST(TorqueCurve, TakesRadiansToo) {
  TorqueCurveDescription radians = paperCurve();
  radians.angle_unit = AngleUnit::kRadian;
  double power = 1.0;
  for (double& c : radians.coefficients) {
    c /= power;
    power *= kDegree;
  }
  radians.blend_start *= kDegree;
  radians.support_begin *= kDegree;
  radians.support_end *= kDegree;
  const TorqueCurve in_degrees(paperCurve());
  const TorqueCurve in_radians(radians);
  for (double psi = 0.0; psi < 0.7; psi += 0.01) {
    EXPECT_NEAR(in_radians.value(psi), in_degrees.value(psi), 1e-14);
  }
}

TEST(TorqueCurve, RefusesAnglesOutOfOrder) {
  TorqueCurveDescription description = paperCurve();
  description.blend_start = 29.0;
  EXPECT_THROW(TorqueCurve{description}, ConfigError);
  description = paperCurve();
  description.support_end = 180.0;
  EXPECT_THROW(TorqueCurve{description}, ConfigError);
  description = paperCurve();
  description.coefficients.clear();
  EXPECT_THROW(TorqueCurve{description}, ConfigError);
  description = paperCurve();
  description.coefficients[2] = std::nan("");
  EXPECT_THROW(TorqueCurve{description}, ConfigError);
}

}  // namespace
}  // namespace sac
