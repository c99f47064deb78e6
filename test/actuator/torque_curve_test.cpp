#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

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
    EXPECT_NEAR(curve.value(degrees * kOneDegree), paperPolynomial(degrees), 1e-14);
  }
  EXPECT_NEAR(curve.value(10.0 * kOneDegree), 0.2843, 1e-4);  // peak of the published curve
}

TEST(TorqueCurve, HasThePublishedCoefficientsNearZero) {
  const TorqueCurve curve(paperCurve());
  EXPECT_NEAR(curve.linearCoefficient(), 2.73064, 1e-5);
  EXPECT_NEAR(curve.cubicCoefficient(), -2.95545, 1e-5);
}

TEST(TorqueCurve, StaysCloseToThePolynomialWhereItLeavesIt) {
  const TorqueCurve curve(paperCurve());
  for (double degrees = 0.0; degrees < 2.0; degrees += 0.01) {
    EXPECT_LE(std::abs(curve.value(degrees * kOneDegree) - paperPolynomial(degrees)), 5.4e-3);
  }
  for (double degrees = 28.0; degrees < 29.93; degrees += 0.01) {
    EXPECT_LE(std::abs(curve.value(degrees * kOneDegree) - paperPolynomial(degrees)), 1.65e-3);
  }
}

TEST(TorqueCurve, IsContinuousWithItsSlopeAtEveryBlend) {
  const TorqueCurve curve(paperCurve());
  for (const double degrees : {2.0, 28.0, 32.0}) {
    const double below = (degrees - 1e-9) * kOneDegree;
    const double above = (degrees + 1e-9) * kOneDegree;
    EXPECT_NEAR(curve.value(below), curve.value(above), 1e-9) << degrees;
    EXPECT_NEAR(curve.derivative(below), curve.derivative(above), 1e-7) << degrees;
  }
}

TEST(TorqueCurve, IsZeroBeyondItsSupport) {
  const TorqueCurve curve(paperCurve());
  for (const double degrees : {32.0, 33.0, 60.0, 179.0}) {
    EXPECT_EQ(curve.value(degrees * kOneDegree), 0.0);
    EXPECT_EQ(curve.derivative(degrees * kOneDegree), 0.0);
  }
}

TEST(TorqueCurve, DerivativeIsTheSlopeOfTheValue) {
  const TorqueCurve curve(paperCurve());
  for (double degrees = 0.5; degrees < 34.0; degrees += 0.97) {
    const double psi = degrees * kOneDegree;
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
    const double kappa = std::cos(degrees * kOneDegree);
    const TorqueCurve::Safe safe = curve.safe(kappa, std::sin(degrees * kOneDegree));
    EXPECT_NEAR(safe.h, h(kappa), 1e-12) << degrees;
    const double step = 1e-7;
    EXPECT_NEAR(safe.dh, (h(kappa + step) - h(kappa - step)) / (2.0 * step), 1e-5) << degrees;
  }
}

TEST(TorqueCurve, SafeFormIsPreciseWhereItsSeriesEnds) {
  // A curve that reaches beyond; f(ψ) = ψ there.
  TorqueCurveDescription description;
  description.coefficients = {0.0, 1.0};
  description.blend_start = 1.0;
  description.support_begin = 80.0;
  description.support_end = 100.0;
  const TorqueCurve curve(description);
  for (double degrees = 0.5; degrees < 79.0; degrees += 0.5) {
    const double psi = degrees * kOneDegree;
    const TorqueCurve::Safe safe = curve.safe(std::cos(psi), std::sin(psi));
    const double expected = degrees / std::sin(psi);
    EXPECT_NEAR(safe.h, expected, 1e-14 * expected / psi) << degrees;
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
    power *= kOneDegree;
  }
  radians.blend_start *= kOneDegree;
  radians.support_begin *= kOneDegree;
  radians.support_end *= kOneDegree;
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

/// So many points of the paper's polynomial, in degrees, to the end of its support.
TorqueCurveDescription tableOfThePaper(int points) {
  TorqueCurveDescription curve;
  for (int n = 0; n < points; ++n) {
    const double degrees = 0.5 + 29.0 * n / (points - 1);
    curve.table.angles.push_back(degrees);
    curve.table.torques.push_back(paperPolynomial(degrees));
  }
  curve.blend_start = paperCurve().blend_start;
  curve.support_begin = paperCurve().support_begin;
  curve.support_end = paperCurve().support_end;
  return curve;
}

/// A spline meets a curve within its points, and nearly so where the curve's parts meet, at which
/// its second derivative jumps.
void expectSameCurve(const TorqueCurve& table, const TorqueCurve& curve) {
  for (double degrees = 0.0; degrees <= 33.0; degrees += 0.1) {
    const double psi = degrees * kOneDegree;
    EXPECT_NEAR(table.value(psi), curve.value(psi), 2.5e-4) << degrees;
    if (degrees > 4.0 && degrees < 26.0) {
      EXPECT_NEAR(table.value(psi), curve.value(psi), 1e-5) << degrees;
      EXPECT_NEAR(table.derivative(psi), curve.derivative(psi), 1e-3) << degrees;
    }
  }
}

TEST(TorqueTable, OfFortyPointsIsThePolynomialThatItWasMadeFrom) {
  expectSameCurve(TorqueCurve(tableOfThePaper(40)), TorqueCurve(paperCurve()));
}

// Points beyond the blends lie on another curve, which bends where it begins.
TEST(TorqueTable, OfTheBlendedCurveIsThatCurve) {
  TorqueCurveDescription table = tableOfThePaper(40);
  const TorqueCurve blended(paperCurve());
  for (std::size_t n = 0; n < table.table.angles.size(); ++n) {
    table.table.angles[n] = 32.0 * static_cast<double>(n) / 39.0;
    table.table.torques[n] = blended.value(table.table.angles[n] * kOneDegree);
  }
  expectSameCurve(TorqueCurve(table), blended);
}

TEST(TorqueTable, GoesThroughItsPointsWithTwoContinuousDerivatives) {
  TorqueCurveDescription description;
  description.table.angles = {0.0, 3.0, 7.0, 10.0, 16.0, 22.0, 30.0};
  description.table.torques = {0.0, 0.13, 0.26, 0.28, 0.25, 0.16, 0.0};
  completeFromTable(description);
  EXPECT_EQ(description.blend_start, 3.0);
  EXPECT_EQ(description.support_begin, 22.0);
  EXPECT_EQ(description.support_end, 30.0);
  const TorqueCurve curve(description);
  constexpr double kStep = 1e-6;
  for (std::size_t n = 0; n + 1 < description.table.angles.size(); ++n) {
    const double psi = description.table.angles[n] * kOneDegree;
    EXPECT_NEAR(curve.value(psi), description.table.torques[n], 1e-14);
  }
  for (const double degrees : {3.0, 7.0, 10.0, 16.0}) {
    const double psi = degrees * kOneDegree;
    const double below = (curve.derivative(psi) - curve.derivative(psi - kStep)) / kStep;
    const double above = (curve.derivative(psi + kStep) - curve.derivative(psi)) / kStep;
    EXPECT_NEAR(below, above, 1e-3) << degrees;  // the third derivative jumps
  }
  EXPECT_NEAR(curve.derivative(30.0 * kOneDegree - 1e-9), 0.0, 1e-6);
}

TEST(TorqueTable, HasTheSafeFormOfItsDerivative) {
  const TorqueCurve curve(tableOfThePaper(12));
  for (const double degrees : {0.01, 1.0, 5.0, 13.7, 29.0}) {
    const double psi = degrees * kOneDegree;
    EXPECT_NEAR(curve.safe(std::cos(psi), std::sin(psi)).h, curve.value(psi) / std::sin(psi), 1e-9);
    const double step = 1e-4 * psi;
    const auto h = [&](double at) { return curve.safe(std::cos(at), std::sin(at)).h; };
    const double numeric =
        (h(psi + step) - h(psi - step)) / (std::cos(psi + step) - std::cos(psi - step));
    const double dh = curve.safe(std::cos(psi), std::sin(psi)).dh;
    EXPECT_NEAR(dh, numeric, 1e-4 * std::abs(dh) + 1e-5) << degrees;
  }
}

TEST(TorqueTable, EndsBeyondItsLastPointWhereThatIsNotZero) {
  TorqueCurveDescription description;
  description.table.angles = {0.0, 7.0, 14.0, 21.0, 28.0};
  description.table.torques = {0.0, 0.25, 0.26, 0.17, 0.06};
  completeFromTable(description);
  EXPECT_EQ(description.support_begin, 28.0);
  EXPECT_NEAR(description.support_end, 32.0, 1e-12);
}

TEST(TorqueTable, StatesItsUncertaintyOverItsPeak) {
  TorqueTable table{{1.0, 2.0}, {0.2, -0.1}, {0.003, 0.004}};
  EXPECT_NEAR(relativeTableStddev(table), std::sqrt(12.5) * 1e-3 / 0.2, 1e-15);
  table.stddevs.clear();
  EXPECT_EQ(relativeTableStddev(table), 0.0);
}

TEST(TorqueTable, RefusesWhatIsNoTable) {
  const auto refused = [](const std::function<void(TorqueCurveDescription&)>& spoil) {
    TorqueCurveDescription curve = tableOfThePaper(10);
    validate(curve);
    spoil(curve);
    EXPECT_THROW(validate(curve), ConfigError);
  };
  refused([](auto& curve) { curve.table.torques.pop_back(); });
  refused([](auto& curve) { curve.table.stddevs = {1.0}; });
  refused([](auto& curve) { curve.table.angles[4] = curve.table.angles[3]; });
  refused([](auto& curve) { curve.table.torques[4] = std::nan(""); });
  refused([](auto& curve) { curve.table.stddevs.assign(10, -1.0); });
  refused([](auto& curve) { curve.blend_start = 0.4; });
  refused([](auto& curve) { curve.support_begin = 29.6; });
  refused([](auto& curve) {
    curve.table.angles.resize(3);
    curve.table.torques.resize(3);
  });
}

}  // namespace
}  // namespace sac
