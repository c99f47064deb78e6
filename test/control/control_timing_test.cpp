#include "spherical_actuator_calibration/control/control_timing.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kPeriod = 1e-3;       // [s]
constexpr double kComputation = 2e-5;  // [s]

CommandTime commandAt(double begin, double age, double interval = kPeriod) {
  return {begin, begin + kComputation, age, interval};
}

TEST(ControlTiming, TellsRateAgeAndComputation) {
  ControlTiming timing;
  for (int n = 0; n <= 100; ++n) {
    timing.add(commandAt(5.0 + n * kPeriod, n == 50 ? 8e-4 : 2e-4));
  }
  const TimingReport report = timing.take();
  EXPECT_EQ(report.commands, 101U);
  EXPECT_NEAR(report.rate, 1000.0, 1e-6);
  EXPECT_LT(report.jitter, 1e-7);
  EXPECT_NEAR(report.longest_period, kPeriod, 1e-9);
  EXPECT_NEAR(report.mean_age, 2e-4 + 6e-4 / 101, 1e-12);
  EXPECT_DOUBLE_EQ(report.largest_age, 8e-4);
  EXPECT_NEAR(report.mean_computation, kComputation, 1e-12);
  EXPECT_NEAR(report.longest_computation, kComputation, 1e-12);
}

TEST(ControlTiming, JitterIsTheStandardDeviationOfThePeriod) {
  ControlTiming timing;
  double begin = 0.0;
  for (int n = 0; n <= 1000; ++n) {
    timing.add(commandAt(begin, 1e-4));
    begin += kPeriod + (n % 2 == 0 ? 1e-4 : -1e-4);
  }
  const TimingReport report = timing.take();
  EXPECT_NEAR(report.jitter, 1e-4, 1e-9);
  EXPECT_NEAR(report.longest_period, 1.1e-3, 1e-9);
}

TEST(ControlTiming, AReadingIsOldWhenTheNextOneIsDue) {
  ControlTiming timing;
  timing.add(commandAt(0.0, 5.0, 0.0));  // the very first: nobody knows when the next one is due
  timing.add(commandAt(0.001, 0.9e-3));
  EXPECT_EQ(timing.oldReadings(), 0U);
  timing.add(commandAt(0.002, 1.1e-3));
  EXPECT_EQ(timing.oldReadings(), 1U);
  EXPECT_EQ(timing.commands(), 3U);
}

TEST(ControlTiming, AnIntervalThatWasShortOnceMakesNoReadingOld) {
  ControlTiming timing;
  for (int n = 0; n < 100; ++n) {
    timing.add(commandAt(n * kPeriod, 5e-4, n == 50 ? 2e-4 : kPeriod));
  }
  EXPECT_EQ(timing.oldReadings(), 0U);
  // A sensor that has become five times as slow for good.
  for (int n = 0; n < 300; ++n) {
    timing.add(commandAt(1.0 + 5.0 * n * kPeriod, 5e-4, 5.0 * kPeriod));
  }
  timing.add(commandAt(3.0, 4e-3, 5.0 * kPeriod));
  EXPECT_EQ(timing.oldReadings(), 0U);
}

TEST(ControlTiming, BeginsAnewAfterAReportAndAfterAnInterruption) {
  ControlTiming timing;
  timing.add(commandAt(0.0, 2e-3));
  timing.add(commandAt(0.5, 2e-3));
  timing.take();
  timing.interrupt();
  timing.add(commandAt(2.0, 1e-4));
  const TimingReport report = timing.take();
  EXPECT_EQ(report.commands, 1U);
  EXPECT_EQ(report.rate, 0.0);
  EXPECT_EQ(report.longest_period, 0.0);
  EXPECT_DOUBLE_EQ(report.largest_age, 1e-4);
  EXPECT_EQ(timing.oldReadings(), 2U);
  EXPECT_EQ(timing.take().commands, 0U);
}

}  // namespace
}  // namespace sac
