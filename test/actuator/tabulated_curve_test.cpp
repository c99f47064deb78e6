#include "spherical_actuator_calibration/actuator/tabulated_curve.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// A curve measured point by point, as a description may hold it.
TorqueCurve measuredCurve() {
  TorqueCurveDescription description;
  for (int degrees = 0; degrees <= 60; degrees += 5) {
    description.table.angles.push_back(degrees);
    description.table.torques.push_back(std::sin(3.0 * degrees * kOneDegree));
  }
  completeFromTable(description);
  return TorqueCurve(description);
}

/// Largest differences of h and dh, beside angles where the curve changes its form.
void expectSame(const TorqueCurve& curve, double tolerance, double slope_tolerance) {
  constexpr double kBeside = 1e-2;  // [rad]
  const TabulatedCurve tabulated(curve);
  for (double psi = 0.0; psi < curve.supportEnd(); psi += 3.7e-5) {
    const double kappa = std::cos(psi);
    const TorqueCurve::Safe expected = curve.safe(kappa, std::sin(psi));
    const TorqueCurve::Safe found = tabulated.at(kappa);
    EXPECT_NEAR(found.h, expected.h, 3e-5) << psi;
    if (std::abs(psi - curve.blendStart()) > kBeside &&
        std::abs(psi - curve.supportBegin()) > kBeside) {
      EXPECT_NEAR(found.h, expected.h, tolerance) << psi;
      EXPECT_NEAR(found.dh, expected.dh, slope_tolerance) << psi;
    }
  }
}

TEST(TabulatedCurve, IsTheCurve) {
  expectSame(TorqueCurve(*scenarios::paperNominal().torque_curve), 1e-8, 1e-3);
}

TEST(TabulatedCurve, IsACurveThatIsATableItself) {
  expectSame(measuredCurve(), 1e-7, 1e-3);
}

TEST(TabulatedCurve, IsTheSlopeOfItsValues) {
  const TabulatedCurve tabulated(TorqueCurve(*scenarios::paperNominal().torque_curve));
  constexpr double kStep = 1e-7;
  for (const double kappa : {0.9, 0.95123, 0.99, 0.9999}) {
    const double slope =
        (tabulated.at(kappa + kStep).h - tabulated.at(kappa - kStep).h) / (2.0 * kStep);
    EXPECT_NEAR(tabulated.at(kappa).dh, slope, 1e-5 * std::abs(slope) + 1e-6) << kappa;
  }
}

TEST(TabulatedCurve, KnowsBothEnds) {
  const TorqueCurve curve(*scenarios::paperNominal().torque_curve);
  const TabulatedCurve tabulated(curve);
  EXPECT_EQ(tabulated.at(1.0 + 1e-15).h, tabulated.at(1.0).h);
  EXPECT_NEAR(tabulated.at(1.0).h, curve.linearCoefficient(), 1e-12);
  EXPECT_EQ(tabulated.at(curve.cosSupportEnd()).h, 0.0);
}

}  // namespace
}  // namespace sac
