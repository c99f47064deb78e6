#include "spherical_actuator_calibration/control/orientation_controller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "control/controlled_rotor.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

using OrientationControllerTest = ControlledRotor;

TEST_F(OrientationControllerTest, TurnsTheLoadedRotorToItsTarget) {
  start(truth_);
  const Eigen::Matrix3d target = rotationExp({0.3, -0.2, 0.8});
  controller_->setTarget(now_, target);
  run(4.0);
  EXPECT_EQ(controller_->state(), ControlState::kActive);
  EXPECT_LT(errorTo(target), 1e-4);
}

TEST_F(OrientationControllerTest, HoldsTheRotorWhereItWasEnabled) {
  rotor_.release({0.2, 0.1, -1.0});
  restart();
  start(truth_);
  const Eigen::Matrix3d held = rotor_.state().R_stator_rotor;
  run(2.0);
  EXPECT_LT(errorTo(held), 1e-4);
}

TEST_F(OrientationControllerTest, UsesEverythingThatWasIdentified) {
  options_.rotor.unbalance.setZero();
  restart();
  Actuator identified = truth_;
  identified.unbalance = loadedRotor().unbalance;
  start(identified);
  const Eigen::Matrix3d target = rotationExp({0.3, -0.2, 0.8});
  controller_->setTarget(now_, target);
  run(4.0);
  EXPECT_LT(errorTo(target), 1e-4);  // 0.01 and more without the weight of the rotor

  // The emulated rotor has no map: told of one, the controller turns it away.
  OrientationMapDescription map;
  map.amplitude = {1e-2, 1e-2, 1e-2};
  map.noise = {1e-5, 1e-5, 1e-5};
  map.readings = {rotor_.position()};
  map.rotations = {{0.01, 0.0, 0.0}};
  identified.orientation_map = std::make_shared<OrientationMap>(map);
  controller_->setParameters(identified);
  controller_->setTarget(now_, target);
  run(4.0);
  EXPECT_GT(errorTo(target), 5e-3);
}

TEST_F(OrientationControllerTest, NewParametersMakeNoJump) {
  start(scenarios::paperNominal());
  const Eigen::Matrix3d target = rotationExp({0.2, 0.2, 0.5});
  controller_->setTarget(now_, target);
  run(4.0);
  EXPECT_GT(errorTo(target), 0.01);
  const Eigen::Vector3d before = trueTorque(controller_->update(now_));
  controller_->setParameters(truth_);
  now_ += kCycle;
  controller_->receive({now_, rotor_.position()});
  const Eigen::Vector3d after = trueTorque(controller_->update(now_));
  EXPECT_GT(before.norm(), 5e-3);
  EXPECT_LT((after - before).norm(), 0.01 * before.norm());
  run(4.0);
  EXPECT_LT(errorTo(target), 1e-4);
}

TEST_F(OrientationControllerTest, NewParametersMakeNoJumpOnTheWayEither) {
  start(scenarios::paperNominal());
  controller_->setTarget(now_, rotationExp({0.2, 0.2, 2.0}));
  run(0.8);
  const Eigen::Vector3d before = trueTorque(controller_->update(now_));
  controller_->setParameters(truth_);
  const Eigen::Vector3d after = trueTorque(controller_->update(now_));
  EXPECT_LT((after - before).norm(), 0.02 * before.norm());
}

TEST_F(OrientationControllerTest, RefusesATargetWhoseWayLeavesTheWorkspace) {
  rotor_.release({0.5, 0.5, 0.0});
  restart();
  start(scenarios::paperNominal());
  const Eigen::Matrix3d R = rotorOrientation(jointGeometry(scenarios::paperNominal().joints),
                                             Eigen::Vector3d(0.5, 0.5, 0.0));
  const Eigen::Matrix3d quarter = rotationExp({0.0, 0.0, 1.5708}) * R;
  try {
    controller_->setTarget(now_, quarter);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("The way to the target"), std::string::npos)
        << error.what();
  }
}

TEST_F(OrientationControllerTest, CurrentsStayWithinTheLimit) {
  constexpr double kLimit = 0.002;
  options_.allocation.current_limit = kLimit;
  restart();
  start(truth_);
  controller_->setTarget(now_, rotationExp({0.3, -0.2, 0.8}));
  EXPECT_LE(run(0.05), kLimit * (1.0 + 1e-9));
  EXPECT_LT(controller_->torqueShare(), 1.0);
}

TEST_F(OrientationControllerTest, BeginsAnewAfterAJumpOfTheClock) {
  start(truth_);
  run(0.1);
  controller_->receive({now_ + 3600000 * kCycle, rotor_.position()});
  controller_->update(now_ + kCycle);
  expectStopped("s old");
  run(0.01);
  controller_->enable(now_);
  run(0.1);
  EXPECT_EQ(controller_->state(), ControlState::kActive);
}

TEST_F(OrientationControllerTest, TheSumOfTheCurrentsStaysWithinItsLimit) {
  constexpr double kTotal = 0.02;
  options_.total_current_limit = kTotal;
  restart();
  start(truth_);
  controller_->setTarget(now_, rotationExp({0.3, -0.2, 0.8}));
  for (int n = 0; n < 50; ++n) {
    run(0.001);
    EXPECT_LE(controller_->update(now_).cwiseAbs().sum(), kTotal * (1.0 + 1e-9));
  }
  EXPECT_LT(controller_->torqueShare(), 1.0);
}

TEST_F(OrientationControllerTest, ThePowerOfTheCoilsStaysWithinItsLimit) {
  constexpr double kSquare = 1e-5;
  options_.square_current_limit = kSquare;
  restart();
  start(truth_);
  controller_->setTarget(now_, rotationExp({0.3, -0.2, 0.8}));
  for (int n = 0; n < 50; ++n) {
    run(0.001);
    EXPECT_LE(controller_->update(now_).squaredNorm(), kSquare * (1.0 + 1e-9));
  }
  EXPECT_LT(controller_->torqueShare(), 1.0);
}

// Once a second somebody looks: what was cut between is told, and by which limit.
TEST_F(OrientationControllerTest, TellsTheLeastShareOfTheTorqueAndTheLimitThatCutIt) {
  const auto cut_by = [&] {
    rotor_.release(Eigen::Vector3d::Zero());
    restart();
    start(truth_);
    controller_->takeTorqueCut();
    controller_->setTarget(now_, rotationExp({0.3, -0.2, 0.8}));
    double least = 1.0;
    for (int n = 0; n < 50; ++n) {
      run(0.001);
      least = std::min(least, controller_->torqueShare());
    }
    const TorqueCut cut = controller_->takeTorqueCut();
    EXPECT_EQ(cut.share, least);
    EXPECT_EQ(controller_->takeTorqueCut().limit, CurrentLimit::kNone);
    return cut.limit;
  };
  EXPECT_EQ(cut_by(), CurrentLimit::kNone);
  options_.square_current_limit = 1e-5;
  EXPECT_EQ(cut_by(), CurrentLimit::kPower);
  options_.total_current_limit = 1e-3;
  EXPECT_EQ(cut_by(), CurrentLimit::kTotal);
  options_.allocation.current_limit = 1e-5;
  EXPECT_EQ(cut_by(), CurrentLimit::kCoil);
}

// Half of what the load needs: that the rotor does not follow is no riddle.
TEST_F(OrientationControllerTest, DisabledItHasNoCurrent) {
  start(truth_);
  EXPECT_GT(run(0.2), 0.001);
  controller_->disable();
  EXPECT_TRUE(controller_->update(now_).isZero(0.0));
  EXPECT_EQ(controller_->state(), ControlState::kIdle);
}

TEST_F(OrientationControllerTest, IsNotEnabledWithoutWhatItNeeds) {
  EXPECT_THROW(controller_->enable(now_), DataError);
  controller_->setParameters(truth_);
  EXPECT_THROW(controller_->enable(now_ + 200 * kCycle), DataError);
  EXPECT_EQ(controller_->state(), ControlState::kIdle);
  OrientationController fresh(scenarios::paperNominal(), options_);
  fresh.setParameters(truth_);
  EXPECT_THROW(fresh.enable(now_), DataError);
}

TEST_F(OrientationControllerTest, RefusesTargetsAndKeepsTheOneBefore) {
  start(truth_);
  const Eigen::Matrix3d target = rotationExp({0.1, 0.0, 0.0});
  controller_->setTarget(now_, target);
  Eigen::Matrix3d broken = target;
  broken(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(controller_->setTarget(now_, broken), DataError);
  EXPECT_THROW(controller_->setTarget(now_, 2.0 * target), DataError);
  EXPECT_THROW(controller_->setTarget(now_, rotationExp({0.0, 0.9, 0.0})), DataError);
  run(3.0);
  EXPECT_LT(errorTo(target), 1e-4);
}

TEST_F(OrientationControllerTest, RefusesReadingsThatAreNotFinite) {
  start(truth_);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(controller_->receive({now_ + kCycle, {0.0, nan, 0.0}}), DataError);
  EXPECT_THROW(controller_->receive({now_ + kCycle, {0.0, 0.0, 1e200}}), DataError);
  run(0.1);
  EXPECT_EQ(controller_->state(), ControlState::kActive);
}

TEST_F(OrientationControllerTest, RefusesParametersOfAnotherDesign) {
  Actuator other = truth_;
  other.coils.pop_back();
  EXPECT_THROW(controller_->setParameters(other), ConfigError);
  other.coils.clear();
  EXPECT_THROW(OrientationController(other, options_), ConfigError);
}

TEST_F(OrientationControllerTest, NamesTheOptionThatIsWrong) {
  options_.velocity_cutoff = -1.0;
  try {
    restart();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("velocity_cutoff"), std::string::npos);
  }
}

}  // namespace
}  // namespace sac
