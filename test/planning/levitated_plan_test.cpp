#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "planning/plan_step.hpp"
#include "planning/planning_fixture.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"
#include "support/error_message.hpp"

namespace sac {
namespace {

/// The reaction sphere, not calibrated, and no samples.
class LevitatedPlan : public ::testing::Test {
 protected:
  LevitatedPlan() {
    problem_.model = &model_;
    problem_.held = &held_;
    problem_.state = nominalState(model_.space(), {});
    options_.max_poses = 8;
    options_.candidates = 60;
    options_.tilt_limit = 0.5;
  }

  CalibrationModel model_{ParameterSpace(scenarios::reactionSphere())};
  std::vector<Sample> held_;
  PlanningProblem problem_;
  PosePlanOptions options_;
};

TEST_F(LevitatedPlan, KnowsNoParametersOfJoints) {
  const PosePlan plan = planPoses(problem_, options_);
  ASSERT_TRUE(plan.success) << plan.message;
  EXPECT_EQ(plan.expected.size(), 56U);
  EXPECT_EQ(plan.orientation_samples, plan.poses.size());
  for (const ParameterEstimate& one : plan.expected) {
    EXPECT_EQ(one.name.find("joint"), std::string::npos);
  }
}

TEST_F(LevitatedPlan, NoiseOfTheTrackerIsInWhatIsExpected) {
  options_.orientation_stddev = 1e-7;
  const double exact = planPoses(problem_, options_).worst_stddev;
  options_.orientation_stddev = 1e-3;
  EXPECT_GT(planPoses(problem_, options_).worst_stddev, 1.3 * exact);
}

TEST_F(LevitatedPlan, WeighingPatternsAreBetterAndHaveABound) {
  options_.orientation_stddev = 1e-5;
  const double single = planPoses(problem_, options_).worst_stddev;
  options_.patterns = PlanPatterns::kWeighing;
  const PosePlan plan = planPoses(problem_, options_);
  EXPECT_LT(plan.worst_stddev, single);
  ASSERT_TRUE(plan.stddev_bound.has_value());
  EXPECT_GE(plan.worst_stddev, *plan.stddev_bound);
}

// The tracker's error is one and the same for all torques of a pose: patterns are chosen with it,
// and the bound counts it.
TEST_F(LevitatedPlan, ComesNearTheBoundWithTheNoiseOfATracker) {
  options_.patterns = PlanPatterns::kWeighing;
  options_.orientation_stddev = 1e-3;
  const PosePlan plan = planPoses(problem_, options_);
  ASSERT_TRUE(plan.stddev_bound.has_value());
  EXPECT_GE(plan.worst_stddev, *plan.stddev_bound);
  EXPECT_LE(plan.worst_stddev, 1.05 * *plan.stddev_bound);
}

// On the polar axis an azimuth is no direction at all: its standard deviation is not one that poses
// could make less.
TEST_F(LevitatedPlan, AnAzimuthOnThePolarAxisIsNotTheWorstParameter) {
  Actuator sphere = scenarios::reactionSphere();
  sphere.coils[0].polar = kPi / 2.0;
  const CalibrationModel model{ParameterSpace(sphere)};
  problem_.model = &model;
  options_.patterns = PlanPatterns::kWeighing;
  options_.wanted_stddev = 5e-3;
  const PosePlan plan = planPoses(problem_, options_);
  ASSERT_TRUE(plan.success) << plan.message;
  EXPECT_NE(plan.worst_parameter, "coil_1/azimuth");
  EXPECT_LT(plan.worst_stddev, 5e-3);
  EXPECT_TRUE(plan.reached_wanted) << plan.message;
}

TEST_F(LevitatedPlan, LevelOneCannotBePlanned) {
  problem_.request = {Cycle::kJoint};
  EXPECT_EQ(errorMessage<ConfigError>([&] { planPoses(problem_, options_); }),
            "cycle: the actuator description has no joints to plan for.");
}

TEST_F(LevitatedPlan, APoseIsReachedOverTheHalfTurn) {
  Sample sample;
  sample.joint_position << 0.1, -0.2, kPi - 0.01;
  EXPECT_TRUE(isAtPose(sample, {0.1, -0.2, -kPi + 0.001}));
  EXPECT_FALSE(isAtPose(sample, {0.1, -0.2, 0.0}));
}

TEST_F(LevitatedPlan, TheOperatorHearsOfTurnsAndNotOfJoints) {
  const PosePlan plan = planPoses(problem_, options_);
  const std::string step = planStep(plan.poses, {}, 0.05, false);
  EXPECT_NE(step.find("turn the rotor to turns about x, y, z of"), std::string::npos) << step;
  EXPECT_EQ(step.find("joint"), std::string::npos);
}

}  // namespace
}  // namespace sac
