#include "current_steps.hpp"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "motion/stepping_currents.hpp"

namespace sac {
namespace {

constexpr double kStep = 0.05;  // [A]

/// Currents of two coils that step up or down and lag, sampled.
MotionStreams stepping(double interval, double phase, double noise) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  MotionStreams streams;
  const auto count = static_cast<Eigen::Index>(std::lround(kDuration / interval));
  streams.currents = StreamCurrents(count, 2);
  Eigen::Vector2d setpoint = Eigen::Vector2d::Zero();
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  long step = 0;
  for (Eigen::Index n = 0; n < count; ++n) {
    const double time = phase + static_cast<double>(n) * interval;
    for (; static_cast<double>(step + 1) * kHold <= time; ++step) {
      before = setpoint + (before - setpoint) * std::exp(-kHold / kLag);
      setpoint = kStep * Eigen::Vector2d(normal(generator), normal(generator));
    }
    const double share = std::exp(-(time - static_cast<double>(step) * kHold) / kLag);
    const Eigen::Vector2d current = setpoint + share * (before - setpoint) +
                                    noise * Eigen::Vector2d(normal(generator), normal(generator));
    streams.current_stamps.push_back(static_cast<Stamp>(std::llround(time * 1e9)));
    streams.currents.row(n) = current.transpose().cast<float>();
  }
  return streams;
}

double delayStddev(const MotionStreams& streams, double noise) {
  CurrentSteps steps;
  steps.add(streams);
  return steps.delayStddev(noise);
}

TEST(CurrentSteps, LeaveTheDelayAsUncertainAsTheyShiftIt) {
  // At most by the interval squared over twelve times the lag.
  for (const double noise : {0.0, 1e-3}) {
    EXPECT_NEAR(delayStddev(stepping(1e-3, 0.0, noise), noise), 50e-6, 15e-6);
    EXPECT_GT(delayStddev(stepping(1e-3, 0.5e-3, noise), noise), 15e-6);
    EXPECT_LT(delayStddev(stepping(0.5e-3, 0.0, noise), noise), 15e-6);
  }
}

// A gentle motion before a lively one, say: its samples hardly count for the delay of both.
TEST(CurrentSteps, CountBySquaresOfTheirChanges) {
  const double sampled = delayStddev(stepping(1e-3, 0.0, 0.0), 0.0);
  MotionStreams told = stepping(1e-3, 0.0, 0.0);
  told.response = CommandResponse();
  told.response->lateness_stddev = 5e-6;
  EXPECT_NEAR(delayStddev(told, 0.0), 5e-6, 1e-9);
  for (const float share : {1.0F, 0.2F}) {
    MotionStreams gentle = stepping(1e-3, 0.0, 0.0);
    gentle.currents.matrix() *= share;
    CurrentSteps both;
    both.add(gentle);
    both.add(told);
    const double weight = share * share;
    EXPECT_NEAR(both.delayStddev(0.0), (weight * sampled + 5e-6) / (weight + 1.0), 1e-7);
  }
  // What is noise alone counts for nothing.
  constexpr double kNoise = 1e-3;
  MotionStreams still = stepping(1e-3, 0.0, 1e3 * kNoise);
  still.currents.matrix() *= 1e-3F;
  CurrentSteps both;
  both.add(still);
  both.add(told);
  EXPECT_LT(both.delayStddev(kNoise), 6e-6);
}

/// Currents of one slope everywhere, sampled for 10 s.
MotionStreams rising(double interval) {
  MotionStreams streams;
  const auto count = static_cast<Eigen::Index>(std::lround(10.0 / interval));
  streams.currents = StreamCurrents(count, 1);
  for (Eigen::Index n = 0; n < count; ++n) {
    const double time = static_cast<double>(n) * interval;
    streams.current_stamps.push_back(static_cast<Stamp>(std::llround(time * 1e9)));
    streams.currents(n, 0) = static_cast<float>(0.1 * time);
  }
  return streams;
}

TEST(CurrentSteps, CountAlikeAtAllRates) {
  MotionStreams slow = rising(5e-3);
  slow.response = CommandResponse();
  slow.response->lateness_stddev = 5e-6;
  CurrentSteps both;
  both.add(slow);
  both.add(rising(1e-3));
  EXPECT_NEAR(both.delayStddev(0.0), 0.5 * (5e-6 + 1e-3 / std::sqrt(12.0)), 1e-6);
}

TEST(CurrentSteps, AreNotThoseOverAGap) {
  const MotionStreams whole = stepping(1e-3, 0.0, 0.0);
  MotionStreams streams = whole;
  const Eigen::Index half = streams.currents.rows() / 2;
  for (auto n = static_cast<std::size_t>(half); n < streams.current_stamps.size(); ++n) {
    streams.current_stamps[n] += 5'000'000'000;
  }
  streams.currents.matrix().bottomRows(half).array() += 5.0F;
  EXPECT_NEAR(delayStddev(streams, 0.0), delayStddev(whole, 0.0), 1e-7);
}

TEST(CurrentSteps, OnceASampleLookSmooth) {
  MotionStreams streams;
  constexpr double kInterval = 5e-3;
  streams.currents = StreamCurrents(2000, 1);
  for (Eigen::Index n = 0; n < 2000; ++n) {
    streams.current_stamps.push_back(static_cast<Stamp>(n) * 5'000'000);
    streams.currents(n, 0) = static_cast<float>(0.3 * std::sin(0.05 * static_cast<double>(n)));
  }
  EXPECT_NEAR(delayStddev(streams, 0.0), kInterval / std::sqrt(12.0), 1e-6);
}

/// A sine in steps without a lag, sampled.
MotionStreams sineInSteps(double interval, double hold) {
  MotionStreams streams;
  streams.currents = StreamCurrents(2000, 1);
  for (Eigen::Index n = 0; n < 2000; ++n) {
    const double time = static_cast<double>(n) * interval;
    const double since = hold * std::floor(time / hold + 1e-9);
    streams.current_stamps.push_back(static_cast<Stamp>(std::llround(time * 1e9)));
    streams.currents(n, 0) = static_cast<float>(0.3 * std::sin(10.0 * since));
  }
  return streams;
}

TEST(CurrentSteps, OfWhichSamplesHaveNowOneNowTwoOrNoneAreNotResolved) {
  // Such samples bend as those of a slow lag do, and are late by what nobody knows.
  const std::vector<std::pair<double, double>> unresolved{{5e-3, 2e-3}, {4e-3, 5e-3}, {5e-3, 3e-3}};
  for (const auto& [interval, hold] : unresolved) {
    EXPECT_NEAR(delayStddev(sineInSteps(interval, hold), 0.0), interval / std::sqrt(12.0), 1e-6)
        << interval << " " << hold;
  }
  EXPECT_GT(delayStddev(sineInSteps(1e-3, 5e-3), 0.0), 3e-4);
}

TEST(CurrentSteps, AreNeverMoreThanHalfAnIntervalOff) {
  const double worst = delayStddev(stepping(5e-3, 0.0, 0.0), 0.0);
  EXPECT_GT(worst, 0.9e-3);
  EXPECT_LE(worst, 2.5e-3 * (1.0 + 1e-9));
  EXPECT_EQ(delayStddev({}, 0.0), 0.0);
}

}  // namespace
}  // namespace sac
