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

/// By what the calibration node tells.
PoseMeasurement judged() {
  PoseMeasurement measurement;
  measurement.judgeBy({0.04, 0.1, 0.09});
  return measurement;
}

CaptureOutcome stored() {
  return {true, "", false};
}

/// One pattern, from its settling to its capture.
void measure(PoseMeasurement& measurement,
             const std::vector<double>& currents,
             const CaptureOutcome& outcome,
             double now) {
  measurement.step(currents, now);
  ASSERT_EQ(measurement.step(currents, now + 0.5), Action::kCapture);
  measurement.captured(outcome, now + 1.0);
}

TEST(PoseMeasurement, CapturesEachPatternOnceItsCurrentsHaveSettled) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.step(zero(), 0.0), Action::kNothing);
  EXPECT_EQ(measurement.step(zero(), 0.4), Action::kCapture);
  EXPECT_EQ(measurement.step(zero(), 0.5), Action::kNothing);
  measurement.captured(stored(), 1.0);
  EXPECT_EQ(measurement.coil(), 2U);
  EXPECT_EQ(measurement.current(), 2.0);
  EXPECT_EQ(measurement.step(zero(), 1.1), Action::kNothing);
  EXPECT_EQ(measurement.step(second(), 1.2), Action::kNothing);
  // Not there all the time.
  EXPECT_EQ(measurement.step(zero(), 1.4), Action::kNothing);
  EXPECT_EQ(measurement.step(second(), 1.6), Action::kNothing);
  EXPECT_EQ(measurement.step(second(), 2.0), Action::kCapture);
  measurement.captured(stored(), 3.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.outcome(), "The pose is measured: 2 samples.");
}

TEST(PoseMeasurement, EndsWhereACoilDoesNotCarryItsCurrent) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  EXPECT_EQ(measurement.step({}, 1.0), Action::kNothing);
  measure(measurement, zero(), stored(), 2.0);
  EXPECT_EQ(measurement.step(zero(), 13.1), Action::kEnd);
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.outcome(), "Coil 2 does not carry its current: look at the coil driver.");
}

TEST(PoseMeasurement, TakesACurrentThatTheNodeWouldTellFromNone) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 0.05, 0.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.outcome(),
            "0.05 A are too little to tell a coil from one that is off: take 0.09 A or more.");
  measurement.begin({0}, 0.05, 0.0);
  EXPECT_TRUE(measurement.isRunning());
  measurement.begin({0, 2}, -0.09, 0.0);
  measure(measurement, zero(), stored(), 1.0);
  measurement.step({0.0, -0.04, 0.0}, 3.0);
  EXPECT_EQ(measurement.step({0.0, -0.04, 0.0}, 4.0), Action::kNothing);
  measurement.step({0.0, -0.06, 0.0}, 5.0);
  EXPECT_EQ(measurement.step({0.0, -0.06, 0.0}, 6.0), Action::kCapture);
}

TEST(PoseMeasurement, EndsWithTheReasonOfACaptureThatFailed) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  measurement.step(zero(), 0.0);
  ASSERT_EQ(measurement.step(zero(), 1.0), Action::kCapture);
  measurement.captured({false, "The rotor moved.", false}, 2.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.outcome(), "The rotor moved.");
}

TEST(PoseMeasurement, AnswersThatNobodyAskedForChangeNothing) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  measurement.captured(stored(), 0.1);
  EXPECT_EQ(measurement.coil(), 0U);
  measurement.end("Stopped.");
  measurement.captured(stored(), 0.2);
  EXPECT_EQ(measurement.outcome(), "Stopped.");
}

TEST(PoseMeasurement, BeginsWithoutCurrentInAnyCase) {
  PoseMeasurement measurement = judged();
  measurement.begin({2}, 2.0, 0.0);
  EXPECT_EQ(measurement.coil(), 0U);
  measure(measurement, zero(), stored(), 1.0);
  EXPECT_EQ(measurement.coil(), 2U);
}

TEST(PoseMeasurement, AfterAnInterruptedRestItsZeroIsMeasuredAnew) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  measure(measurement, zero(), stored(), 1.0);
  measure(measurement, second(), {false, "The rest was interrupted.", true}, 2.0);
  EXPECT_TRUE(measurement.isRunning());
  EXPECT_EQ(measurement.coil(), 0U);
  measure(measurement, zero(), stored(), 4.0);
  EXPECT_EQ(measurement.coil(), 2U);
  measure(measurement, second(), stored(), 5.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.outcome(), "The pose is measured: 3 samples.");
}

}  // namespace
}  // namespace sac
