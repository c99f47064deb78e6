#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "control/control_cycle.hpp"
#include "control/wrong_actuator.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "spherical_actuator_calibration/emulation/free_rotor.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Some tilt, the spin beyond ±π, and currents in all coils.
MotionPlan examplePlan(double excitation) {
  MotionPlan plan;
  plan.actuator = scenarios::paperNominal().name;
  plan.duration = 6.0;
  plan.ramp = 1.0;
  plan.joints[0] = {0.0, {{0.31, 0.2, 0.1}, {0.73, 0.1, 0.3}}};
  plan.joints[1] = {0.0, {{0.37, 0.2, 0.7}}};
  plan.joints[2] = {0.0, {{0.06, 3.3, -1.5}}};
  for (int j = 0; j < 24; ++j) {
    plan.coils.push_back(
        {{1.0 + 0.1 * j, excitation, 1.0 * j}, {4.0 - 0.03 * j, excitation, 1.0 * j * j}});
  }
  return plan;
}

/// Seconds of an approach to the begin by a rotor of such a rate [rad/s], until it is left.
double approachTime(double rotor_rate) {
  constexpr double kTenCycles = 10.0 * kStep;
  MotionRun run(examplePlan(0.0));
  double time = 0.0;
  while (run.phase() == MotionPhase::kApproach &&
         run.approach(kTenCycles, 0.0, 0.0, rotor_rate).empty()) {
    time += kTenCycles;
  }
  return time;
}

TEST(MotionApproach, WaitsForARotorThatRestsOrNearlyDoes) {
  EXPECT_LT(approachTime(0.05), 1.0);
  EXPECT_NEAR(approachTime(0.5), 10.5, 0.1);
  // The control cannot hold it.
  EXPECT_NEAR(approachTime(0.7), 30.0, 0.1);
}

/// The controller knows the drawing, the rotor is another.
class MotionFollowingTest : public ::testing::Test {
 protected:
  void start(const Actuator& truth) {
    RigidRotor body;
    body.unbalance = Eigen::Vector3d(0.003, -0.004, 0.002);
    rotor_.emplace(truth, body, 0.9, BearingFriction{{1e-4, 5e-4}, 0.05});
    rotor_->release({0.1, 0.0, 0.3});
    controller_.emplace(scenarios::paperNominal(), options_);
    controller_->setParameters(scenarios::paperNominal());
    controller_->receive({now_, rotor_->position()});
    controller_->enable(now_);
  }

  void step() {
    now_ += kCycle;
    controller_->receive({now_, rotor_->position()});
    const Eigen::VectorXd& currents = controller_->update(now_);
    largest_coil_ = std::max(largest_coil_, currents.cwiseAbs().maxCoeff());
    largest_total_ = std::max(largest_total_, currents.cwiseAbs().sum());
    largest_square_ = std::max(largest_square_, currents.squaredNorm());
    rotor_->advance(1e-3, currents);
    largest_tilt_ = std::max(largest_tilt_, rotor_->position().head<2>().cwiseAbs().maxCoeff());
    largest_spin_ = std::max(largest_spin_, std::abs(rotor_->position().z()));
  }

  void runFor(double seconds) {
    for (int n = 0; n < std::lround(seconds * 1e3); ++n) {
      step();
    }
  }

  MotionPhase phase() { return controller_->motionProgress().phase; }

  /// Until the phase is over.
  void runWhile(MotionPhase during, double at_most = 40.0) {
    for (int n = 0; n < std::lround(at_most * 1e3) && phase() == during; ++n) {
      step();
    }
  }

  /// To the middle of the motion.
  void runIntoMotion(const MotionPlan& plan) {
    controller_->follow(plan);
    runWhile(MotionPhase::kApproach);
    ASSERT_EQ(phase(), MotionPhase::kMotion) << controller_->stopReason();
    runFor(0.5 * plan.duration);
    ASSERT_EQ(phase(), MotionPhase::kMotion) << controller_->stopReason();
  }

  void expectStopped(const std::string& reason) {
    EXPECT_EQ(phase(), MotionPhase::kStopped);
    EXPECT_EQ(controller_->state(), ControlState::kStopped);
    EXPECT_NE(controller_->stopReason().find(reason), std::string::npos)
        << controller_->stopReason();
    EXPECT_TRUE(controller_->update(now_).isZero(0.0));
  }

  OrientationControllerOptions options_;
  std::optional<FreeRotor> rotor_;
  std::optional<OrientationController> controller_;
  Stamp now_ = 1000 * kCycle;
  double largest_coil_ = 0.0;
  double largest_total_ = 0.0;
  double largest_square_ = 0.0;
  double largest_tilt_ = 0.0;
  double largest_spin_ = 0.0;
};

TEST_F(MotionFollowingTest, EndsAtRestWithoutCurrentAndStaysInTheWorkspaceHoweverWrongTheModel) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    start(wrongBy30mrad(seed));
    controller_->follow(examplePlan(0.1));
    runWhile(MotionPhase::kApproach);
    ASSERT_EQ(phase(), MotionPhase::kMotion) << controller_->stopReason();
    runWhile(MotionPhase::kMotion);
    runWhile(MotionPhase::kSettling);
    EXPECT_EQ(phase(), MotionPhase::kDone) << controller_->stopReason();
    EXPECT_EQ(controller_->state(), ControlState::kIdle);
    EXPECT_TRUE(controller_->update(now_).isZero(0.0));
    EXPECT_LT(rotor_->state().angular_velocity.norm(), 0.1);
    EXPECT_LT(largest_tilt_, 0.6);
    EXPECT_GT(largest_spin_, 3.0);
  }
}

TEST_F(MotionFollowingTest, TheExcitationCostsNoMotionWhereTheModelIsRight) {
  double errors[2];
  for (const bool is_excited : {false, true}) {
    start(scenarios::paperNominal());
    options_.rotor.unbalance = Eigen::Vector3d(0.003, -0.004, 0.002);
    start(scenarios::paperNominal());
    largest_total_ = 0.0;
    runIntoMotion(examplePlan(is_excited ? 0.15 : 0.0));
    errors[is_excited ? 1 : 0] = controller_->motionProgress().largest_tracking_error;
    EXPECT_GT(largest_total_, is_excited ? 3.0 : 0.0);
    EXPECT_LT(largest_total_, is_excited ? 8.0 : 2.0);
  }
  EXPECT_NEAR(errors[1], errors[0], 2e-3);
}

TEST_F(MotionFollowingTest, LimitsCutTheExcitationBeforeTheTorque) {
  MotionPlan plan = examplePlan(0.3);
  plan.limits.coil_current = 0.6;
  plan.limits.total_current = 3.0;
  plan.limits.square_current = 0.8;
  start(scenarios::paperNominal());
  runIntoMotion(plan);
  EXPECT_LE(largest_coil_, 0.6 * (1.0 + 1e-9));
  EXPECT_LE(largest_total_, 3.0 * (1.0 + 1e-9));
  EXPECT_LE(largest_square_, 0.8 * (1.0 + 1e-9));
  EXPECT_GT(std::max({largest_coil_ / 0.6, largest_total_ / 3.0, largest_square_ / 0.8}), 0.99);
  const MotionProgress progress = controller_->motionProgress();
  EXPECT_EQ(progress.least_torque_share, 1.0);
}

TEST_F(MotionFollowingTest, LimitsOfTheControllerHoldAsWell) {
  options_.allocation.current_limit = 0.4;
  options_.total_current_limit = 2.0;
  options_.square_current_limit = 0.3;
  start(scenarios::paperNominal());
  runIntoMotion(examplePlan(0.3));
  EXPECT_LE(largest_square_, 0.3 * (1.0 + 1e-9));
  EXPECT_LE(largest_coil_, 0.4 * (1.0 + 1e-9));
  EXPECT_LE(largest_total_, 2.0 * (1.0 + 1e-9));
}

// Far too much current for what the drawing knows: without fading the rotor would leave.
TEST_F(MotionFollowingTest, ExcitationFadesWhereTheRotorIsFarFromItsReference) {
  start(wrongBy30mrad(4));
  controller_->follow(examplePlan(0.6));
  runWhile(MotionPhase::kApproach);
  double least = 1.0;
  for (int n = 0; n < 5000 && phase() == MotionPhase::kMotion; ++n) {
    step();
    least = std::min(least, controller_->motionProgress().least_excitation_share);
  }
  EXPECT_LT(least, 0.9);
  EXPECT_LT(largest_tilt_, 0.6);
}

TEST_F(MotionFollowingTest, EndsEarlyWhenItIsWanted) {
  start(wrongBy30mrad(5));
  runIntoMotion(examplePlan(0.1));
  controller_->endMotion();
  EXPECT_EQ(phase(), MotionPhase::kEnding);
  const double elapsed = controller_->motionProgress().elapsed;
  runWhile(MotionPhase::kEnding);
  EXPECT_NEAR(controller_->motionProgress().elapsed, elapsed + 1.0, 0.01);
  runWhile(MotionPhase::kSettling);
  EXPECT_EQ(phase(), MotionPhase::kDone);
  EXPECT_EQ(controller_->state(), ControlState::kIdle);
  EXPECT_LT(rotor_->state().angular_velocity.norm(), 0.1);
  // What is over does not end what comes after it.
  controller_->enable(now_);
  runFor(0.1);
  EXPECT_EQ(controller_->state(), ControlState::kActive);
}

TEST_F(MotionFollowingTest, StopsOnOldJointAngles) {
  start(wrongBy30mrad(6));
  runIntoMotion(examplePlan(0.1));
  EXPECT_TRUE(controller_->update(now_ + 101 * kCycle).isZero(0.0));
  expectStopped("s old");
}

TEST_F(MotionFollowingTest, StopsWhenItIsPushedAway) {
  start(wrongBy30mrad(7));
  runIntoMotion(examplePlan(0.1));
  for (int n = 0; n < 500 && phase() == MotionPhase::kMotion; ++n) {
    step();
    rotor_->advance(1e-3, Eigen::VectorXd::Zero(24), {0.2, 0.0, 0.0});
  }
  expectStopped("does not follow");
  EXPECT_TRUE(controller_->isLost());
}

TEST_F(MotionFollowingTest, StopsWhereTheSensorStandsStill) {
  start(wrongBy30mrad(8));
  runIntoMotion(examplePlan(0.1));
  const Eigen::Vector3d frozen = rotor_->position();
  for (int n = 0; n < 2000 && phase() == MotionPhase::kMotion; ++n) {
    now_ += kCycle;
    controller_->receive({now_, frozen});
    controller_->update(now_);
  }
  expectStopped("does not follow");
}

TEST_F(MotionFollowingTest, WithoutCurrentWhenItIsDisabled) {
  start(wrongBy30mrad(9));
  runIntoMotion(examplePlan(0.1));
  controller_->disable();
  EXPECT_TRUE(controller_->update(now_).isZero(0.0));
  EXPECT_EQ(phase(), MotionPhase::kStopped);
  controller_->enable(now_);
  runFor(0.1);
  EXPECT_EQ(phase(), MotionPhase::kStopped);
}

TEST_F(MotionFollowingTest, NewParametersWaitForTheEnd) {
  const Actuator truth = wrongBy30mrad(10);
  start(truth);
  runIntoMotion(examplePlan(0.1));
  const Eigen::VectorXd before = controller_->update(now_);
  controller_->setParameters(truth);
  EXPECT_TRUE(controller_->hasParametersToCome());
  EXPECT_LT((controller_->update(now_) - before).norm(), 1e-9);
  controller_->endMotion();
  runWhile(MotionPhase::kEnding);
  runWhile(MotionPhase::kSettling);
  EXPECT_FALSE(controller_->hasParametersToCome());
  // By the true parameters the same motion is followed far better.
  const auto largest_error = [this] {
    controller_->enable(now_);
    runIntoMotion(examplePlan(0.1));
    return controller_->motionProgress().largest_tracking_error;
  };
  const double calibrated = largest_error();
  start(truth);
  controller_->disable();
  EXPECT_LT(calibrated, 0.7 * largest_error());
}

TEST_F(MotionFollowingTest, RefusesWhatItMustNotDo) {
  start(scenarios::paperNominal());
  MotionPlan wild = examplePlan(0.1);
  wild.joints[0].centre = 0.3;
  EXPECT_THROW(controller_->follow(wild), ConfigError);
  EXPECT_EQ(phase(), MotionPhase::kNone);
  controller_->follow(examplePlan(0.1));
  EXPECT_THROW(controller_->follow(examplePlan(0.1)), DataError);
  EXPECT_THROW(controller_->setTarget(now_, Eigen::Matrix3d::Identity()), DataError);
  controller_->endMotion();
  step();
  EXPECT_EQ(phase(), MotionPhase::kDone);
  EXPECT_EQ(controller_->state(), ControlState::kIdle);
  EXPECT_THROW(controller_->follow(examplePlan(0.1)), DataError);
}

}  // namespace
}  // namespace sac
