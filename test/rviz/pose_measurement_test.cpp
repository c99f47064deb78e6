#include "pose_measurement.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

using Action = PoseMeasurement::Action;

std::vector<double> zero() {
  return {0.0, 0.0, 0.0};
}

std::vector<double> second() {
  return {0.01, 1.98, 0.0};
}

TEST(PoseMeasurement, CapturesEachPatternOnceItsCurrentsHaveSettled) {
  PoseMeasurement measurement;
  measurement.begin({0, 2}, 2.0, 0.0);
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.step(zero(), 0.0), Action::kNothing);
  EXPECT_EQ(measurement.step(zero(), 0.4), Action::kCapture);
  EXPECT_EQ(measurement.step(zero(), 0.5), Action::kNothing);
  measurement.answered(true, "Sample 1.", 1.0);
  EXPECT_EQ(measurement.coil(), 2U);
  EXPECT_EQ(measurement.current(), 2.0);
  EXPECT_EQ(measurement.step(zero(), 1.1), Action::kNothing);
  EXPECT_EQ(measurement.step(second(), 1.2), Action::kNothing);
  // Not there all the time.
  EXPECT_EQ(measurement.step(zero(), 1.4), Action::kNothing);
  EXPECT_EQ(measurement.step(second(), 1.6), Action::kNothing);
  EXPECT_EQ(measurement.step(second(), 2.0), Action::kCapture);
  measurement.answered(true, "Sample 2.", 3.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.outcome(), "The pose is measured: 2 samples.");
}

TEST(PoseMeasurement, EndsWhereACoilDoesNotCarryItsCurrent) {
  PoseMeasurement measurement;
  measurement.begin({2}, 2.0, 0.0);
  EXPECT_EQ(measurement.step({}, 1.0), Action::kNothing);
  EXPECT_EQ(measurement.step(zero(), 10.1), Action::kEnd);
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.outcome(), "Coil 2 does not carry its current: look at the coil driver.");
}

TEST(PoseMeasurement, EndsWithTheReasonOfACaptureThatFailed) {
  PoseMeasurement measurement;
  measurement.begin({0, 2}, 2.0, 0.0);
  measurement.step(zero(), 0.0);
  ASSERT_EQ(measurement.step(zero(), 1.0), Action::kCapture);
  measurement.answered(false, "The rotor moved.", 2.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.outcome(), "The rotor moved.");
}

TEST(PoseMeasurement, AnswersThatNobodyAskedForChangeNothing) {
  PoseMeasurement measurement;
  measurement.begin({0, 2}, 2.0, 0.0);
  measurement.answered(true, "Sample of somebody else.", 0.1);
  EXPECT_EQ(measurement.coil(), 0U);
  measurement.end("Stopped.");
  measurement.answered(true, "Late.", 0.2);
  EXPECT_EQ(measurement.outcome(), "Stopped.");
}

}  // namespace
}  // namespace sac
