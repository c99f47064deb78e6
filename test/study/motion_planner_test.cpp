#include "spherical_actuator_calibration/study/motion_planner.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kError = 0.03;  // of every parameter [rad]

MotionPlannerOptions quickOptions() {
  MotionPlannerOptions options;
  options.duration = 8.0;
  options.ramp = 1.0;
  options.candidates = 2;
  options.rehearsals = 1;
  options.rehearsal.rotor.unbalance = Eigen::Vector3d(0.003, -0.004, 0.002);
  return options;
}

TEST(MotionPlanner, RehearsalsWithWrongModelsStayWithinAllLimits) {
  MotionPlannerOptions options = quickOptions();
  options.rehearsals = 2;
  const Actuator actuator = scenarios::paperNominal();
  const PlannedMotionResult result = planMotion(actuator, options);
  validate(result.record.plan, actuator);
  ASSERT_EQ(result.rehearsals.size(), 2U);
  for (const Rehearsal& rehearsal : result.rehearsals) {
    EXPECT_TRUE(rehearsal.completed) << rehearsal.reason;
    EXPECT_LT(rehearsal.largest_tilt, actuator.workspace.tilt_limit);
    EXPECT_LT(rehearsal.largest_tracking_error, options.limits.error);
    EXPECT_LE(rehearsal.largest_coil_current, options.limits.coil_current * (1.0 + 1e-9));
    EXPECT_LE(rehearsal.largest_total_current, options.limits.total_current * (1.0 + 1e-9));
    EXPECT_LE(rehearsal.largest_square_current, options.limits.square_current * (1.0 + 1e-9));
    EXPECT_GT(rehearsal.mean_total_current, 0.5);
    EXPECT_GT(rehearsal.mean_excitation_share, 0.6);
  }
  ASSERT_EQ(result.record.expected.size(), 73U);
  // Eight seconds tell of everything.
  EXPECT_LT(result.worst_stddev, 1e-3);
}

// Where a wrong model turns torques round, a weaker excitation does not help.
TEST(MotionPlanner, TakesAnotherMotionBeforeAWeakerExcitation) {
  MotionPlannerOptions options = quickOptions();
  options.duration = 20.0;
  options.candidates = 4;
  options.rehearsals = 2;
  options.model_error = 0.04;
  options.excitation = 0.1;
  options.seed = 4;
  int failed = 0;
  const PlannedMotionResult result =
      planMotion(scenarios::paperNominal(), options, [&](const std::string& text) {
        failed += text.find("does not follow") != std::string::npos ? 1 : 0;
      });
  EXPECT_GT(failed, 0);
  EXPECT_LT(failed, 4);
  EXPECT_EQ(result.excitation, options.excitation);
}

// Whatever is asked: what the guards leave of it stays in the workspace.
TEST(MotionPlanner, NoExcitationBringsTheRotorOutOfTheWorkspace) {
  const Actuator actuator = scenarios::paperNominal();
  MotionPlannerOptions options = quickOptions();
  options.excitation = 0.5;
  options.limits.total_current = 20.0;
  options.limits.square_current = 50.0;
  const MotionPlan plan =
      drawMotions(actuator, options, [](const MotionPlan& /*plan*/) { return 0.0; }).front();
  RehearsalOptions rehearsal = options.rehearsal;
  rehearsal.controller.total_current_limit = 20.0;
  double largest_error = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Actuator truth = manufacturedActuator(actuator, {kError, kError, kError, kError}, seed);
    const Rehearsal result = rehearse(plan, actuator, truth, rehearsal);
    EXPECT_LT(result.largest_tilt, actuator.workspace.tilt_limit) << result.reason;
    largest_error = std::max(largest_error, result.largest_tracking_error);
  }
  EXPECT_GT(largest_error, 0.3 * options.limits.error);
}

TEST(MotionPlanner, TheSeedDecidesAndTheScoreChooses) {
  const Actuator actuator = scenarios::paperNominal();
  MotionPlannerOptions options = quickOptions();
  options.candidates = 5;
  int seen = 0;
  const auto third = [&seen](const MotionPlan& /*plan*/) { return ++seen == 3 ? 0.0 : 1.0; };
  const MotionPlan plan = drawMotions(actuator, options, third).front();
  EXPECT_EQ(seen, 5);
  seen = 0;
  const MotionPlan again = drawMotions(actuator, options, third).front();
  EXPECT_EQ(renderMotionPlan({"", plan, {}}), renderMotionPlan({"", again, {}}));
  options.candidates = 1;
  seen = 0;
  EXPECT_NE(renderMotionPlan({"", drawMotions(actuator, options, third).front(), {}}),
            renderMotionPlan({"", plan, {}}));
}

TEST(MotionInformation, GrowsWithTimeAndCurrentAndFallsWithNoise) {
  const Actuator actuator = scenarios::paperNominal();
  const CalibrationModel model{ParameterSpace(actuator)};
  MotionPlannerOptions options = quickOptions();
  const auto worst = [&](const MotionSensors& sensors) {
    const MotionPlan plan =
        drawMotions(actuator, options, [](const MotionPlan& /*plan*/) { return 0.0; }).front();
    return expectedStddevs(model, {}, plan, sensors, 2).maxCoeff();
  };
  options.excitation = 0.05;
  const double base = worst({});
  EXPECT_LT(base, 2e-3);
  options.excitation = 0.1;
  EXPECT_LT(worst({}), 0.8 * base);
  options.excitation = 0.05;
  MotionSensors noisy;
  noisy.joint_stddev *= 2.0;
  noisy.current_stddev *= 2.0;
  noisy.tracker_stddev *= 2.0;
  EXPECT_NEAR(worst(noisy) / base, 2.0, 0.1);
  options.duration = 24.0;
  EXPECT_LT(worst({}), 0.8 * base);
}

TEST(MotionPlanner, NamesTheOptionThatIsWrong) {
  MotionPlannerOptions options = quickOptions();
  options.ramp = 5.0;
  EXPECT_THROW(planMotion(scenarios::paperNominal(), options), ConfigError);
  options = quickOptions();
  options.sensors.joint_stddev = 0.0;
  EXPECT_THROW(planMotion(scenarios::paperNominal(), options), ConfigError);
  options = quickOptions();
  options.limits.tilt = 0.59;
  EXPECT_THROW(planMotion(scenarios::paperNominal(), options), ConfigError);
}

}  // namespace
}  // namespace sac
