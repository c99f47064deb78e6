#include "pose_measurement.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

using Action = PoseMeasurement::Action;
using Flaw = CaptureOutcome::Flaw;

/// By what the calibration node tells.
PoseMeasurement judged() {
  PoseMeasurement measurement;
  measurement.requireAtLeast(0.09);
  return measurement;
}

CaptureOutcome stored() {
  return {true, "", Flaw::kNone};
}

CaptureOutcome amiss() {
  return {false, "Coil 2 does not carry its current.", Flaw::kExcitation};
}

/// One pattern, from its settling to its capture.
void measure(PoseMeasurement& measurement, const CaptureOutcome& outcome, double now) {
  ASSERT_EQ(measurement.step(now + 0.5), Action::kCapture);
  measurement.captured(outcome, now + 1.0);
}

TEST(PoseMeasurement, CapturesEachPatternOnceItHasSettled) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.step(0.0), Action::kNothing);
  EXPECT_EQ(measurement.step(0.4), Action::kCapture);
  EXPECT_EQ(measurement.step(0.5), Action::kNothing);
  measurement.captured(stored(), 1.0);
  EXPECT_EQ(measurement.coil(), 2U);
  EXPECT_EQ(measurement.current(), 2.0);
  EXPECT_EQ(measurement.step(1.1), Action::kNothing);
  EXPECT_EQ(measurement.step(1.4), Action::kCapture);
  measurement.captured(stored(), 3.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.outcome(), "The pose is measured: 2 samples.");
}

TEST(PoseMeasurement, AsksAgainWhileTheCurrentsAreNotThere) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  measure(measurement, stored(), 0.0);
  ASSERT_EQ(measurement.step(1.4), Action::kCapture);
  measurement.captured(amiss(), 1.5);
  EXPECT_EQ(measurement.coil(), 2U);
  EXPECT_EQ(measurement.step(1.55), Action::kNothing);
  EXPECT_EQ(measurement.step(1.65), Action::kCapture);
  measurement.captured(stored(), 2.0);
  EXPECT_EQ(measurement.outcome(), "The pose is measured: 2 samples.");
}

TEST(PoseMeasurement, EndsWhereACoilDoesNotCarryItsCurrent) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  measure(measurement, stored(), 1.0);
  measure(measurement, amiss(), 5.0);
  EXPECT_TRUE(measurement.isRunning());
  measure(measurement, amiss(), 12.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.coil(), 0U);
  EXPECT_EQ(measurement.outcome(), "Coil 2 does not carry its current.");
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
  EXPECT_TRUE(measurement.isRunning());
}

TEST(PoseMeasurement, EndsWithTheReasonOfACaptureThatFailed) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  measurement.step(0.0);
  ASSERT_EQ(measurement.step(1.0), Action::kCapture);
  measurement.captured({false, "The rotor moved.", Flaw::kNone}, 2.0);
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
  measure(measurement, stored(), 1.0);
  EXPECT_EQ(measurement.coil(), 2U);
}

TEST(PoseMeasurement, AfterAnInterruptedRestItsZeroIsMeasuredAnew) {
  PoseMeasurement measurement = judged();
  measurement.begin({0, 2}, 2.0, 0.0);
  measure(measurement, stored(), 1.0);
  measure(measurement, {false, "The rest was interrupted.", Flaw::kRestInterrupted}, 2.0);
  EXPECT_TRUE(measurement.isRunning());
  EXPECT_EQ(measurement.coil(), 0U);
  measure(measurement, stored(), 4.0);
  EXPECT_EQ(measurement.coil(), 2U);
  measure(measurement, stored(), 5.0);
  EXPECT_FALSE(measurement.isRunning());
  EXPECT_EQ(measurement.outcome(), "The pose is measured: 3 samples.");
}

}  // namespace
}  // namespace sac
