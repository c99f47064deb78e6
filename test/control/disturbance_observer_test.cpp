#include "spherical_actuator_calibration/control/disturbance_observer.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "control/control_cycle.hpp"
#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr double kCutoff = 150.0;  // [rad/s]
Eigen::Vector3d exampleLoad() {
  return {0.004, -0.003, 0.002};
}

/// A ball, on which no gyroscopic torque acts, under a load and the torque of its coils.
class DisturbanceObserverTest : public ::testing::Test {
 protected:
  void run(double seconds, Learning learning = Learning::kFree) {
    for (int n = 0; n < std::lround(seconds / kStep); ++n) {
      velocity_ += kStep / kInertia * (load_ + coils_);
      // What is known of it comes late.
      seen_.angular_velocity +=
          -std::expm1(-kStep * kCutoff) * (velocity_ - seen_.angular_velocity);
      observer_.update(kStep, rotor_, seen_, coils_, learning);
    }
  }

  static constexpr double kInertia = 1e-3;  // [kg·m²]
  RigidRotor rotor_{Eigen::Vector3d::Constant(kInertia).asDiagonal(), Eigen::Vector3d::Zero()};
  Eigen::Vector3d load_ = exampleLoad();
  Eigen::Vector3d coils_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  RotorState seen_;
  DisturbanceObserver observer_{DisturbanceObserverOptions{}, kCutoff};
};

TEST_F(DisturbanceObserverTest, FindsAConstantLoadWithItsBandwidth) {
  run(0.1);
  // 6.7 ms of its first 0.1 s are the filter's.
  EXPECT_NEAR(observer_.torque().norm() / exampleLoad().norm(), 1.0 - std::exp(-0.93), 0.02);
  run(1.4);
  EXPECT_LT((observer_.torque() - exampleLoad()).norm(), 1e-5 * exampleLoad().norm());
}

TEST_F(DisturbanceObserverTest, FindsNothingInWhatTheCoilsDo) {
  load_.setZero();
  double largest = 0.0;
  for (int n = 0; n < 40; ++n) {
    coils_ = n % 8 < 4 ? Eigen::Vector3d(0.0, 0.01, 0.0) : Eigen::Vector3d(0.0, -0.01, 0.0);
    run(0.05);
    largest = std::max(largest, observer_.torque().norm());
  }
  EXPECT_LT(largest, 5e-4);  // 1.2e-3 and more where their torques came earlier than velocities
}

TEST_F(DisturbanceObserverTest, FindsNothingInWeightThatIsKnown) {
  rotor_.unbalance = Eigen::Vector3d(0.0, 0.0088, 0.003);
  load_ = gravityTorque(rotor_, seen_.R_stator_rotor);
  run(0.5);
  EXPECT_LT(observer_.torque().norm(), 2e-5);
}

TEST_F(DisturbanceObserverTest, FindsNothingInAFreeRotorThatTumbles) {
  rotor_.inertia = Eigen::Vector3d(0.7e-3, 0.7e-3, 1.3e-3).asDiagonal();
  RotorState state;
  state.angular_velocity = Eigen::Vector3d(3.0, 0.0, 4.0);
  for (int n = 0; n < 500; ++n) {
    state = advance(
        rotor_,
        state,
        [](const Eigen::Matrix3d&) { return Eigen::Vector3d::Zero().eval(); },
        kStep);
    observer_.update(kStep, rotor_, state, Eigen::Vector3d::Zero(), Learning::kFree);
  }
  // Of 7 mN·m that turn its momentum.
  EXPECT_LT(observer_.torque().norm(), 5e-5);
}

TEST_F(DisturbanceObserverTest, GoesNoFurtherThanItMay) {
  load_ *= 100.0;
  run(1.0);
  EXPECT_NEAR(observer_.torque().norm(), DisturbanceObserverOptions{}.largest_torque, 1e-9);
}

TEST_F(DisturbanceObserverTest, MayOnlyForgetWhereItMustNotGrow) {
  run(0.2, Learning::kNoGrowth);
  EXPECT_EQ(observer_.torque().norm(), 0.0);
  run(1.0);
  const double found = observer_.torque().norm();
  load_.setZero();
  run(0.2, Learning::kNoGrowth);
  EXPECT_LT(observer_.torque().norm(), 0.3 * found);
}

TEST_F(DisturbanceObserverTest, KeepsWhatItFoundWhereItMustNotLearn) {
  run(1.0);
  const Eigen::Vector3d found = observer_.torque();
  load_.setZero();
  run(1.0, Learning::kNone);
  EXPECT_EQ(observer_.torque(), found);
  observer_.reset();
  EXPECT_TRUE(observer_.torque().isZero(0.0));
}

TEST_F(DisturbanceObserverTest, AnInterruptionIsNoTorque) {
  run(1.0);
  const Eigen::Vector3d found = observer_.torque();
  // By other parameters the same rotor turns otherwise.
  velocity_ += Eigen::Vector3d(1.0, 0.0, 0.0);
  seen_.angular_velocity = velocity_;
  observer_.interrupt();
  run(1e-3);
  EXPECT_EQ(observer_.torque(), found);
}

TEST_F(DisturbanceObserverTest, WithoutBandwidthItFindsNothing) {
  observer_ = DisturbanceObserver({0.0, 0.03}, kCutoff);
  run(1.0);
  EXPECT_TRUE(observer_.torque().isZero(0.0));
}

TEST_F(DisturbanceObserverTest, NamesTheOptionThatIsWrong) {
  for (const auto& [options, name] :
       {std::pair{DisturbanceObserverOptions{31.0, 0.03}, "disturbance bandwidth"},
        std::pair{DisturbanceObserverOptions{10.0, 0.0}, "largest disturbance torque"}}) {
    try {
      DisturbanceObserver observer(options, kCutoff);
      FAIL();
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sac
