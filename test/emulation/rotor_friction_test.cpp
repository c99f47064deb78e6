#include "spherical_actuator_calibration/emulation/rotor_friction.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/emulation/free_rotor.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

Eigen::Vector3d moments() {
  return {0.7e-3, 0.8e-3, 1.3e-3};
}

TEST(BearingFriction, ViscousFrictionSlowsExponentially) {
  const BearingFriction friction{{2e-3, 0.0}, 0.05};
  const Eigen::Matrix3d inertia = moments().asDiagonal();
  const Eigen::Vector3d begin(1.0, -2.0, 0.5);
  Eigen::Vector3d w = begin;
  for (int n = 0; n < 500; ++n) {
    w = slowedBy(friction, inertia, w, 1e-3);
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(w[k], begin[k] * std::exp(-0.5 * 2e-3 / moments()[k]), 1e-5);
  }
}

TEST(BearingFriction, DryFrictionBringsToRestAndNoFurther) {
  const BearingFriction friction{{0.0, 2e-3}, 1e-3};
  const Eigen::Matrix3d inertia = 1e-3 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d w(0.0, 0.0, 1.0);
  // 2 rad/s² less every second, until 0.5 s have passed.
  for (int n = 0; n < 250; ++n) {
    w = slowedBy(friction, inertia, w, 1e-3);
  }
  EXPECT_NEAR(w.z(), 0.5, 1e-3);
  for (int n = 0; n < 400; ++n) {
    w = slowedBy(friction, inertia, w, 1e-3);
    ASSERT_GE(w.z(), 0.0);
  }
  EXPECT_LT(w.z(), 1e-3);
  // A step that is far too long is none beyond rest either.
  const Eigen::Vector3d begin(0.0, 0.0, 1.0);
  EXPECT_GE(slowedBy({{0.1, 0.0}, 0.05}, inertia, begin, 0.1).z(), 0.0);
}

TEST(BearingFriction, IsTheTorqueOfItsEquation) {
  const BearingFriction friction{{1e-3, 2e-3}, 0.3};
  const Eigen::Vector3d w(0.0, 0.4, 0.0);
  constexpr double kInertia = 1e-3;
  constexpr double kStep = 1e-6;
  const Eigen::Vector3d slower =
      slowedBy(friction, kInertia * Eigen::Matrix3d::Identity(), w, kStep);
  const double torque = kInertia * (slower - w).y() / kStep;
  EXPECT_NEAR(torque, -(1e-3 + 2e-3 / 0.5) * 0.4, 1e-7);
}

TEST(BearingFriction, AFreeRotorLosesItsEnergyToItAndTurnsOnWithoutIt) {
  const auto speed_after_a_second = [](const BearingFriction& friction) {
    FreeRotor rotor(scenarios::paperNominal(), {}, 0.9, friction);
    rotor.release(Eigen::Vector3d::Zero());
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(24);
    const Eigen::Vector3d push(0.0, 0.0, 0.02);
    for (int n = 0; n < 1000; ++n) {
      rotor.advance(1e-3, none, n < 100 ? push : Eigen::Vector3d::Zero().eval());
    }
    return rotor.state().angular_velocity.z();
  };
  // An impulse of 2 mN·m·s on 1.3 g·m².
  EXPECT_NEAR(speed_after_a_second({}), 2e-3 / 1.3e-3, 1e-6);
  const double slowed = speed_after_a_second({{1e-3, 0.0}, 0.05});
  // The equation's own solution.
  const double rate = 1e-3 / 1.3e-3;
  EXPECT_NEAR(slowed, 0.02 / 1e-3 * (1.0 - std::exp(-0.1 * rate)) * std::exp(-0.9 * rate), 1e-5);
}

TEST(BearingFriction, APushDoesNotTurnWithTheRotor) {
  FreeRotor rotor(scenarios::paperNominal(), {}, 0.9);
  rotor.release({0.0, 0.0, 1.5707963});
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(24);
  for (int n = 0; n < 20; ++n) {
    rotor.advance(1e-3, none, {0.01, 0.0, 0.0});
  }
  const Eigen::Vector3d w_stator = rotor.state().R_stator_rotor * rotor.state().angular_velocity;
  EXPECT_GT(w_stator.x(), 0.1);
  EXPECT_LT(std::abs(w_stator.y()), 0.01 * w_stator.x());
}

TEST(BearingFriction, NamesWhatCannotBe) {
  EXPECT_THROW(validate(BearingFriction{{-1e-3, 0.0}, 0.05}), ConfigError);
  EXPECT_THROW(validate(BearingFriction{{0.0, 0.0}, 0.0}), ConfigError);
}

}  // namespace
}  // namespace sac
