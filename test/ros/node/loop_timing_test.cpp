#include "spherical_actuator_calibration/ros/node/loop_timing.hpp"

#include <map>
#include <string>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kLoopPeriod = 1e-3;  // [s]
constexpr double kWork = 2e-5;        // [s]

LoopTurn turnAt(double begin, double age, double interval = kLoopPeriod) {
  return {begin, begin + kWork, age, interval};
}

TEST(LoopTiming, TellsRateAgeAndDuration) {
  LoopTiming timing;
  for (int n = 0; n <= 100; ++n) {
    timing.add(turnAt(5.0 + n * kLoopPeriod, n == 50 ? 8e-4 : 2e-4));
  }
  const TimingReport report = timing.take();
  EXPECT_EQ(report.turns, 101U);
  EXPECT_NEAR(report.rate, 1000.0, 1e-6);
  EXPECT_LT(report.jitter, 1e-7);
  EXPECT_NEAR(report.longest_period, kLoopPeriod, 1e-9);
  EXPECT_NEAR(report.mean_age, 2e-4 + 6e-4 / 101, 1e-12);
  EXPECT_DOUBLE_EQ(report.largest_age, 8e-4);
  EXPECT_NEAR(report.mean_duration, kWork, 1e-12);
  EXPECT_NEAR(report.longest_duration, kWork, 1e-12);
}

TEST(LoopTiming, JitterIsTheStandardDeviationOfThePeriod) {
  LoopTiming timing;
  double begin = 0.0;
  for (int n = 0; n <= 1000; ++n) {
    timing.add(turnAt(begin, 1e-4));
    begin += kLoopPeriod + (n % 2 == 0 ? 1e-4 : -1e-4);
  }
  const TimingReport report = timing.take();
  EXPECT_NEAR(report.jitter, 1e-4, 1e-9);
  EXPECT_NEAR(report.longest_period, 1.1e-3, 1e-9);
}

TEST(LoopTiming, AReadingIsOldWhenTheNextOneIsDue) {
  LoopTiming timing;
  timing.add(turnAt(0.0, 5.0, 0.0));  // the very first: nobody knows when the next one is due
  timing.add(turnAt(0.001, 0.9e-3));
  EXPECT_EQ(timing.oldTurns(), 0U);
  timing.add(turnAt(0.002, 1.1e-3));
  EXPECT_EQ(timing.oldTurns(), 1U);
  EXPECT_EQ(timing.turns(), 3U);
}

TEST(LoopTiming, AnIntervalThatWasShortOnceMakesNoReadingOld) {
  LoopTiming timing;
  for (int n = 0; n < 100; ++n) {
    timing.add(turnAt(n * kLoopPeriod, 5e-4, n == 50 ? 2e-4 : kLoopPeriod));
  }
  EXPECT_EQ(timing.oldTurns(), 0U);
  // A sensor that has become five times as slow for good.
  for (int n = 0; n < 300; ++n) {
    timing.add(turnAt(1.0 + 5.0 * n * kLoopPeriod, 5e-4, 5.0 * kLoopPeriod));
  }
  timing.add(turnAt(3.0, 4e-3, 5.0 * kLoopPeriod));
  EXPECT_EQ(timing.oldTurns(), 0U);
}

TEST(LoopTiming, BeginsAnewAfterAReportAndAfterAnInterruption) {
  LoopTiming timing;
  timing.add(turnAt(0.0, 2e-3));
  timing.add(turnAt(0.5, 2e-3));
  timing.take();
  timing.interrupt();
  timing.add(turnAt(2.0, 1e-4));
  const TimingReport report = timing.take();
  EXPECT_EQ(report.turns, 1U);
  EXPECT_EQ(report.rate, 0.0);
  EXPECT_EQ(report.longest_period, 0.0);
  EXPECT_DOUBLE_EQ(report.largest_age, 1e-4);
  EXPECT_EQ(timing.oldTurns(), 2U);
  EXPECT_EQ(timing.take().turns, 0U);
}

TEST(LoopTiming, WhatIsMadeOfNothingNewHasNoAge) {
  LoopTiming timing;
  timing.add(turnAt(0.0, 2e-4));
  timing.add({kLoopPeriod, kLoopPeriod + 3.0 * kWork, std::nullopt});
  const TimingReport report = timing.take();
  EXPECT_EQ(report.turns, 2U);
  EXPECT_DOUBLE_EQ(report.mean_age, 2e-4);
  EXPECT_NEAR(report.mean_duration, 2.0 * kWork, 1e-12);
  EXPECT_NEAR(report.rate, 1.0 / kLoopPeriod, 1e-9);
}

TEST(TimingDiagnostics, TellsOfTheTurnsSinceItWasAskedLast) {
  TimingDiagnostics diagnostics("beats", "command", "exchange");
  diagnostics.add(turnAt(1.0, 2e-4));
  diagnostics.add(turnAt(1.0 + kLoopPeriod, 4e-4));
  const auto told = [&] {
    diagnostic_updater::DiagnosticStatusWrapper status;
    diagnostics.run(status);
    std::map<std::string, std::string> values;
    for (const auto& item : status.values) {
      values[item.key] = item.value;
    }
    return values;
  };
  const auto values = told();
  EXPECT_EQ(values.at("beats"), "2");
  EXPECT_NEAR(std::stod(values.at("mean age of the command [us]")), 300.0, 1e-3);
  EXPECT_NEAR(std::stod(values.at("largest age of the command [us]")), 400.0, 1e-3);
  EXPECT_NEAR(std::stod(values.at("mean exchange [us]")), 20.0, 1e-3);
  EXPECT_EQ(told().at("beats"), "0");
}

}  // namespace
}  // namespace sac
