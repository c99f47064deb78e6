#include "spherical_actuator_calibration/emulation/free_rotor.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "emulation/time_step.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kStopTilt = 0.9;

class FreeRotorTest : public ::testing::Test {
 protected:
  Eigen::VectorXd no_current_ = Eigen::VectorXd::Zero(24);
};

TEST_F(FreeRotorTest, RestsWhereNothingActsOnIt) {
  FreeRotor rotor(scenarios::paperTruth(), {}, kStopTilt);
  const Eigen::Vector3d q(0.2, -0.1, 1.0);
  rotor.release(q);
  for (int n = 0; n < 1000; ++n) {
    rotor.advance(kTimeStep, no_current_);
  }
  EXPECT_LT((rotor.position() - q).norm(), 1e-9);
}

TEST_F(FreeRotorTest, SwingsAsAPendulum) {
  RigidRotor body;
  body.inertia = Eigen::Vector3d(1e-3, 1e-3, 1e-3).asDiagonal();
  body.unbalance = Eigen::Vector3d(0.0, 0.0, -0.01);
  FreeRotor rotor(scenarios::paperNominal(), body, kStopTilt);
  rotor.release({0.05, 0.0, 0.0});
  // Half a period of small swings.
  const double half = kPi * std::sqrt(1e-3 / 0.01);
  for (int n = 0; n < std::lround(half / kTimeStep); ++n) {
    rotor.advance(kTimeStep, no_current_);
  }
  EXPECT_NEAR(rotor.position().x(), -0.05, 1e-4);
}

TEST_F(FreeRotorTest, ComesToRestAtTheStopAndLeavesItAgain) {
  RigidRotor body;
  body.unbalance = Eigen::Vector3d(0.0, 0.0, 0.02);
  FreeRotor rotor(scenarios::paperNominal(), body, kStopTilt);
  rotor.release({0.1, 0.0, 0.0});
  for (int n = 0; n < 3000; ++n) {
    rotor.advance(kTimeStep, no_current_);
  }
  EXPECT_TRUE(rotor.isAtStop());
  EXPECT_LE(rotor.position().x(), kStopTilt);
  EXPECT_GT(rotor.position().x(), kStopTilt - 0.05);
  EXPECT_EQ(rotor.state().angular_velocity.norm(), 0.0);
  rotor.release({0.0, 0.0, 0.0});
  EXPECT_FALSE(rotor.isAtStop());
}

TEST_F(FreeRotorTest, ACoilMovesIt) {
  FreeRotor rotor(scenarios::paperNominal(), {}, kStopTilt);
  rotor.release({0.0, 0.0, 0.1});
  Eigen::VectorXd currents = no_current_;
  currents[0] = 1.0;
  for (int n = 0; n < 50; ++n) {
    rotor.advance(kTimeStep, currents);
  }
  EXPECT_GT(rotor.state().angular_velocity.norm(), 0.1);
}

TEST_F(FreeRotorTest, RefusesWhatCannotMove) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.coils.clear();
  EXPECT_THROW(FreeRotor(joint_only, {}, kStopTilt), ConfigError);
  EXPECT_THROW(FreeRotor(scenarios::paperNominal(), {}, 2.0), ConfigError);
}

}  // namespace
}  // namespace sac
