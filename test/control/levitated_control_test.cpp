#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "spherical_actuator_calibration/emulation/free_rotor.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr Stamp kTrackerPeriod = 4166667;  // at 240 Hz [ns]
constexpr double kNoise = 1e-3;            // of the tracker, uniform within ± this [rad]

/// The shipped rotor without joints in the hands of its coils, seen by a tracker.
class LevitatedControl : public ::testing::Test {
 protected:
  LevitatedControl()
      : truth_(manufacturedActuator(scenarios::reactionSphere(), {}, 4)),
        rotor_(truth_, loadedRotor(), 1.0) {
    OrientationControllerOptions options;
    options.rotor = loadedRotor();
    controller_.emplace(scenarios::reactionSphere(), options);
    controller_->receive(seen());
    controller_->setParameters(truth_);
    controller_->enable(now_);
  }

  static RigidRotor loadedRotor() {
    RigidRotor rotor;
    rotor.unbalance = Eigen::Vector3d(0.002, 0.004, 0.001);
    return rotor;
  }

  /// What the tracker measures now.
  OrientationMeasurement seen() {
    std::uniform_real_distribution<double> noise(-kNoise, kNoise);
    const Eigen::Vector3d error(noise(generator_), noise(generator_), noise(generator_));
    return {now_, Eigen::Quaterniond(rotationExp(error) * rotor_.state().R_stator_rotor)};
  }

  void run(double seconds) {
    constexpr int kSteps = 5;  // of the rotor in a cycle
    for (Stamp end = now_ + static_cast<Stamp>(1e9 * seconds); now_ < end;) {
      now_ += kTrackerPeriod;
      controller_->receive(seen());
      const Eigen::VectorXd currents = controller_->update(now_);
      for (int n = 0; n < kSteps; ++n) {
        rotor_.advance(1e-9 * kTrackerPeriod / kSteps, currents);
      }
    }
  }

  double errorTo(const Eigen::Matrix3d& target) const {
    return rotationLog(target.transpose() * rotor_.state().R_stator_rotor).norm();
  }

  Actuator truth_;
  FreeRotor rotor_;
  std::optional<OrientationController> controller_;
  std::mt19937 generator_{7};
  Stamp now_ = 1000000000;
};

TEST_F(LevitatedControl, TurnsTheLoadedRotorToItsTarget) {
  const Eigen::Matrix3d target = rotationExp({0.3, -0.2, 0.8});
  controller_->setTarget(now_, target);
  run(4.0);
  ASSERT_EQ(controller_->state(), ControlState::kActive) << controller_->stopReason();
  EXPECT_LT(errorTo(target), 1e-3);
}

TEST_F(LevitatedControl, TurnsOnOverTheHalfTurn) {
  for (double angle = 1.0; angle < 9.0; angle += 1.0) {
    const Eigen::Matrix3d target = rotationExp({0.0, 0.0, angle});
    controller_->setTarget(now_, target);
    run(2.0);
    ASSERT_EQ(controller_->state(), ControlState::kActive) << controller_->stopReason();
    EXPECT_LT(errorTo(target), 1e-3);
  }
}

TEST_F(LevitatedControl, StopsOnOldOrientations) {
  now_ += 48 * kTrackerPeriod;
  EXPECT_TRUE(controller_->update(now_).isZero(0.0));
  EXPECT_EQ(controller_->state(), ControlState::kStopped);
  EXPECT_EQ(controller_->stopReason(), "the orientations are 0.2 s old");
}

TEST_F(LevitatedControl, StopsOutsideTheWorkspace) {
  now_ += kTrackerPeriod;
  controller_->receive({now_, Eigen::Quaterniond(rotationExp({0.0, 0.8, 0.0}))});
  EXPECT_TRUE(controller_->update(now_).isZero(0.0));
  EXPECT_NE(controller_->stopReason().find("outside of the workspace"), std::string::npos);
}

TEST_F(LevitatedControl, RefusesWhatIsNoOrientation) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Quaterniond& q :
       {Eigen::Quaterniond(1.1, 0.0, 0.0, 0.0), Eigen::Quaterniond(nan, 0.0, 0.0, 0.0)}) {
    EXPECT_THROW(controller_->receive(OrientationMeasurement{now_ + kTrackerPeriod, q}), DataError);
  }
  EXPECT_FALSE(controller_->receive(seen()));  // no newer than the last
}

TEST_F(LevitatedControl, IsNotEnabledBeforeAnOrientationCame) {
  OrientationController controller(scenarios::reactionSphere(), {});
  controller.setParameters(truth_);
  EXPECT_EQ(errorMessage<DataError>([&] { controller.enable(now_); }), "no orientations have come");
}

}  // namespace
}  // namespace sac
