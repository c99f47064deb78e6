#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/actuator_design.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr std::uint64_t kUnitSeed = 11;

TEST(ManufacturingErrors, StayWithinTheirBoundsAndUseThem) {
  const Actuator nominal = scenarios::paperNominal();
  ManufacturingErrors errors;
  errors.strength = 0.02;
  const Actuator made = manufacturedActuator(nominal, errors, kUnitSeed);
  EXPECT_NO_THROW(validate(made));
  double largest_angle = 0.0;
  double largest_gain = 0.0;
  for (std::size_t j = 0; j < nominal.coils.size(); ++j) {
    largest_angle = std::max(largest_angle, std::abs(made.coils[j].polar - nominal.coils[j].polar));
    largest_gain = std::max(largest_gain, std::abs(made.coils[j].gain - 1.0));
    EXPECT_LE(std::abs(made.coils[j].azimuth - nominal.coils[j].azimuth), 0.02 + 1e-12);
  }
  EXPECT_LE(largest_angle, 0.02 + 1e-12);
  EXPECT_GT(largest_angle, 0.015);
  EXPECT_LE(largest_gain, 0.02);
  EXPECT_GT(largest_gain, 0.015);
  for (std::size_t k = 0; k < kJoints; ++k) {
    EXPECT_NE(made.joints[k].offset, 0.0);
    EXPECT_LE(std::abs(made.joints[k].offset), 0.03);
    EXPECT_LE((made.joints[k].axis - nominal.joints[k].axis).norm(), 0.03 * std::sqrt(2.0));
    // Nominal axes are those of the coordinates: two components lie across.
    for (std::size_t across = 1; across < kJoints; ++across) {
      const auto component = static_cast<Eigen::Index>((k + across) % kJoints);
      EXPECT_GT(std::abs(made.joints[k].axis[component]), 1e-5);
    }
  }
}

TEST(ManufacturingErrors, OfZeroLeaveTheNominalActuator) {
  const Actuator nominal = scenarios::paperNominal();
  const Actuator made = manufacturedActuator(nominal, {0.0, 0.0, 0.0, 0.0, 0.0}, kUnitSeed);
  for (std::size_t i = 0; i < nominal.poles.size(); ++i) {
    EXPECT_NEAR(made.poles[i].azimuth, nominal.poles[i].azimuth, 1e-15);
    EXPECT_EQ(made.poles[i].gain, 1.0);
  }
  EXPECT_EQ(made.joints[2].axis, nominal.joints[2].axis);
}

TEST(ManufacturingErrors, LeadOverThePoleOfTheCoordinates) {
  Actuator nominal = scenarios::paperNominal();
  nominal.coils = {{kPi / 2.0, 0.0, 1.0}};
  ManufacturingErrors errors;
  errors.coil_angle = 0.5;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_NO_THROW(validate(manufacturedActuator(nominal, errors, seed)));
  }
}

TEST(ManufacturingErrors, DependOnTheSeed) {
  const Actuator nominal = scenarios::paperNominal();
  const Actuator made = manufacturedActuator(nominal, {}, kUnitSeed);
  EXPECT_EQ(made.coils[7].polar, manufacturedActuator(nominal, {}, kUnitSeed).coils[7].polar);
  EXPECT_NE(made.coils[7].polar, manufacturedActuator(nominal, {}, kUnitSeed + 1).coils[7].polar);
}

TEST(ManufacturingErrors, RefuseBoundsThatCannotBe) {
  EXPECT_THROW(validate(ManufacturingErrors{-0.01}), ConfigError);
  EXPECT_THROW(validate(ManufacturingErrors{0.03, 0.03, 0.02, 0.6}), ConfigError);
}

TEST(ManufacturingErrors, TruthMustBeOfTheSameDesign) {
  const Actuator nominal = scenarios::paperNominal();
  Actuator truth = nominal;
  EXPECT_NO_THROW(requireSameDesign(nominal, truth));
  truth.joints[1].name = "elbow";
  EXPECT_THROW(requireSameDesign(nominal, truth), ConfigError);
  truth = nominal;
  truth.poles.pop_back();
  EXPECT_THROW(requireSameDesign(nominal, truth), ConfigError);
  truth = nominal;
  truth.coils.pop_back();
  EXPECT_THROW(requireSameDesign(nominal, truth), ConfigError);
  truth = nominal;
  truth.torque_curve.reset();
  EXPECT_THROW(requireSameDesign(nominal, truth), ConfigError);
}

TEST(ManufacturingErrors, AStretchedCurveIsWiderAndNothingElse) {
  constexpr double kStretch = 0.01;
  const TorqueCurveDescription drawn = *scenarios::paperNominal().torque_curve;
  const TorqueCurve curve(drawn);
  const TorqueCurve wider(stretchedCurve(drawn, kStretch));
  for (double psi = 0.005; psi < 0.6; psi += 0.005) {
    EXPECT_NEAR(wider.value((1.0 + kStretch) * psi), curve.value(psi), 1e-12) << psi;
  }
  ManufacturingErrors errors;
  errors.curve_stretch = kStretch;
  const Actuator made = manufacturedActuator(scenarios::paperNominal(), errors, 3);
  const Actuator without = manufacturedActuator(scenarios::paperNominal(), {}, 3);
  EXPECT_NEAR(made.torque_curve->support_end, 1.01 * drawn.support_end, 1e-12);
  EXPECT_EQ(made.poles.front().polar, without.poles.front().polar);
  errors.curve_stretch = 0.5;
  EXPECT_THROW(manufacturedActuator(scenarios::paperNominal(), errors, 3), ConfigError);
}

}  // namespace
}  // namespace sac
