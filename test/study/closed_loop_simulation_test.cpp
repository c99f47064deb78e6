#include "spherical_actuator_calibration/study/closed_loop_simulation.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kRate = kPi / 48.0;  // of the paper's trajectory [rad/s]

/// The paper's trajectory q₁ = πt/48 (Figure 14).
DesiredMotion paperTrajectory(double time) {
  DesiredMotion desired;
  desired.R_stator_rotor = rotationExp({kRate * time, 0.0, 0.0});
  desired.angular_velocity = Eigen::Vector3d(kRate, 0.0, 0.0);
  return desired;
}

ClosedLoopOptions controlledBy(const Actuator& model) {
  ClosedLoopOptions options;
  options.truth = scenarios::paperTruth();
  options.model = model;
  return options;
}

/// Nominal poles and coils on the true joints: what level 1 alone gives.
Actuator levelOne() {
  Actuator actuator = scenarios::paperNominal();
  actuator.joints = scenarios::paperTruth().joints;
  return actuator;
}

double errorAtTheEnd(const ClosedLoopOptions& options) {
  const ClosedLoopResult result = simulateClosedLoop(options, paperTrajectory);
  EXPECT_TRUE(result.completed);
  return result.points.back().rotation_error;
}

TEST(InverseKinematics, FindsTheAnglesOfAnOrientation) {
  const JointGeometry joints = jointGeometry(scenarios::paperTruth().joints);
  scenarios::Generator generator(1);
  for (const Eigen::Vector3d& q : scenarios::randomPoses(50, 0.6, generator)) {
    const auto found =
        jointAngles(joints, rotorOrientation(joints, q), q + Eigen::Vector3d(0.05, -0.05, 0.1));
    ASSERT_TRUE(found);
    EXPECT_LT((*found - q).norm(), 1e-9);
  }
}

TEST(InverseKinematics, HasNoAnglesInAGimbalLock) {
  JointGeometry joints = jointGeometry(scenarios::paperNominal().joints);
  joints.axes.col(2) = joints.axes.col(0);
  joints.axes.col(1) = joints.axes.col(0);
  EXPECT_FALSE(jointAngles(joints, rotationExp({0.0, 0.4, 0.0}), Eigen::Vector3d::Zero()));
}

TEST(ClosedLoop, IsThePapersFigureBeforeAndAfterCalibration) {
  EXPECT_NEAR(errorAtTheEnd(controlledBy(scenarios::paperNominal())), 0.060, 0.002);
  EXPECT_LT(errorAtTheEnd(controlledBy(levelOne())), 1e-4);
  EXPECT_LT(errorAtTheEnd(controlledBy(scenarios::paperTruth())), 1e-4);
}

/// With a centre of gravity beside the joint's first axis, where it loads that axis most.
TEST(ClosedLoop, UnderALoadBothLevelsShow) {
  const auto loaded = [](const Actuator& model) {
    ClosedLoopOptions options = controlledBy(model);
    options.rotor.unbalance = Eigen::Vector3d(0.0, 8.8e-3, 0.0);
    const ClosedLoopResult result = simulateClosedLoop(options, paperTrajectory);
    EXPECT_TRUE(result.completed);
    double largest = 0.0;
    for (const ClosedLoopPoint& point : result.points) {
      largest = std::max(largest, point.rotation_error);
    }
    return largest;
  };
  EXPECT_NEAR(loaded(scenarios::paperNominal()), 0.090, 0.003);
  EXPECT_NEAR(loaded(levelOne()), 0.018, 0.003);
  EXPECT_LT(loaded(scenarios::paperTruth()), 1e-4);
}

TEST(ClosedLoop, HalfTheStepMakesNoDifference) {
  ClosedLoopOptions options = controlledBy(scenarios::paperNominal());
  options.duration = 4.0;
  const double error = errorAtTheEnd(options);
  options.step *= 0.5;
  EXPECT_NEAR(errorAtTheEnd(options), error, 1e-5);
}

TEST(ClosedLoop, EndsWhereTheModelMakesNoTorque) {
  ClosedLoopOptions options = controlledBy(scenarios::paperTruth());
  options.allocation.least_singular_value = 10.0;
  const ClosedLoopResult result = simulateClosedLoop(options, paperTrajectory);
  EXPECT_FALSE(result.completed);
  EXPECT_TRUE(result.points.empty());
}

TEST(ClosedLoop, KeepsTheCurrentsWithinTheLimit) {
  ClosedLoopOptions options = controlledBy(scenarios::paperNominal());
  options.duration = 2.0;
  options.rotor.unbalance = Eigen::Vector3d(0.0, 0.02, 0.05);
  options.allocation.current_limit = 0.15;
  for (const ClosedLoopPoint& point : simulateClosedLoop(options, paperTrajectory).points) {
    EXPECT_LE(point.largest_current, 0.15 + 1e-12);
  }
}

TEST(ClosedLoop, RefusesOptionsThatCannotBe) {
  ClosedLoopOptions options = controlledBy(scenarios::paperNominal());
  options.step = 0.0;
  EXPECT_THROW(simulateClosedLoop(options, paperTrajectory), ConfigError);
  options = controlledBy(scenarios::paperNominal());
  options.gains.derivative = std::nan("");
  EXPECT_THROW(simulateClosedLoop(options, paperTrajectory), ConfigError);
  options = controlledBy(scenarios::paperNominal());
  options.model.torque_curve.reset();
  EXPECT_THROW(simulateClosedLoop(options, paperTrajectory), ConfigError);
}

}  // namespace
}  // namespace sac
