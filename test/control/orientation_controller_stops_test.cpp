// When the controller takes the currents to zero by itself, and what it says then.
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "control/controlled_rotor.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

using OrientationControllerStops = ControlledRotor;

TEST_F(OrientationControllerStops, StopsOnOldJointAngles) {
  start(truth_);
  run(0.1);
  const Stamp late = now_ + 101 * kCycle;
  EXPECT_TRUE(controller_->update(late).isZero(0.0));
  expectStopped("s old");
  // It does not come back by itself.
  now_ = late;
  run(0.1);
  expectStopped("s old");
  controller_->enable(now_);
  run(0.1);
  EXPECT_EQ(controller_->state(), ControlState::kActive);
}

TEST_F(OrientationControllerStops, StopsOutsideTheWorkspace) {
  start(truth_);
  run(0.1);
  now_ += kCycle;
  controller_->receive({now_, {0.0, 0.66, 0.0}});
  controller_->update(now_);
  expectStopped("outside of the workspace");
}

TEST_F(OrientationControllerStops, StopsWhereTheCoilsMakeNoTorqueInSomeDirection) {
  start(truth_);
  run(0.002);
  // A curve of hardly any torque, as parameters that come while the rotor is held.
  Actuator weak = truth_;
  for (double& coefficient : weak.torque_curve->coefficients) {
    coefficient *= 1e-6;
  }
  controller_->setParameters(weak);
  run(0.002);
  expectStopped("no torque in some direction");
}

TEST_F(OrientationControllerStops, IsNotEnabledWhereTheCoilsCannotHoldTheRotor) {
  options_.allocation.least_singular_value = 10.0;
  restart();
  const std::string said = errorMessage<DataError>([&] { start(truth_); });
  EXPECT_NE(said.find("no torque in some direction here"), std::string::npos) << said;
  EXPECT_EQ(controller_->state(), ControlState::kIdle);
}

TEST_F(OrientationControllerStops, StopsWhenTheRotorDoesNotFollow) {
  start(truth_);
  controller_->setTarget(now_, rotationExp({0.0, 0.0, 1.2}));
  // A sensor that stands still: fresh stamps, the same angles.
  for (int n = 0; n < 2000; ++n) {
    now_ += kCycle;
    controller_->receive({now_, Eigen::Vector3d::Zero()});
    controller_->update(now_);
  }
  expectStopped("does not follow");
}

TEST_F(OrientationControllerStops, StopsWhenMeasuredCurrentsComeNoMore) {
  start(truth_);
  run(1.0);  // none ever came: whoever drives the coils does not tell
  EXPECT_EQ(controller_->state(), ControlState::kActive);
  for (int n = 0; n < 20; ++n) {
    controller_->receiveCurrents(CurrentMeasurement{now_, controller_->update(now_)});
    run(0.005);
  }
  run(0.2);
  EXPECT_EQ(controller_->state(), ControlState::kActive);
  run(0.1);
  expectStopped("no measured currents have come for 0.25 s");
  EXPECT_FALSE(controller_->isLost());
  controller_->enable(now_);
  run(0.5);
  EXPECT_EQ(controller_->state(), ControlState::kActive);
}

TEST_F(OrientationControllerStops, TellsWhetherTheCurrentsAreThoseItCommands) {
  for (const double share : {0.0, 1.0}) {
    restart();
    start(truth_);
    controller_->setTarget(now_, rotationExp({0.0, 0.0, 1.2}));
    for (int n = 0; n < 2000 && controller_->state() == ControlState::kActive; ++n) {
      now_ += kCycle;
      controller_->receive({now_, Eigen::Vector3d::Zero()});
      const Eigen::VectorXd current = share * controller_->update(now_);
      controller_->receiveCurrents(CurrentMeasurement{now_, current});
    }
    expectStopped("does not follow");
    const bool is_told =
        controller_->stopReason().find("see to the amplifier") != std::string::npos;
    EXPECT_EQ(is_told, share == 0.0) << controller_->stopReason();
    EXPECT_EQ(controller_->isLost(), share != 0.0);
  }
}

TEST_F(OrientationControllerStops, TellsTheLimitWhereTheRotorDoesNotFollowForIt) {
  options_.square_current_limit = 1e-4;
  restart();
  start(truth_);
  run(1.0);
  expectStopped("does not follow");
  expectStopped("at their limit (power/limit, of all coils): down to");
}

}  // namespace
}  // namespace sac
