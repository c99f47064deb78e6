#include "motion_span.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kLeastSpeed = 0.05;  // [rad/s]
constexpr double kBegin = 2.0;        // of the motion [s]

/// At 200 Hz, with noise: a rest of two seconds, then joint 2 turns to and fro four times a second.
MotionStreams restThenMotion(double noise) {
  constexpr double kStep = 0.005;
  constexpr double kFrequency = 25.0;  // [rad/s]
  std::mt19937_64 generator(3);
  std::normal_distribution<double> error(0.0, noise);
  MotionStreams streams;
  streams.currents = StreamCurrents(800, 1);
  for (int n = 0; n < 800; ++n) {
    const double t = n * kStep;
    const double q = t < kBegin ? 0.0 : 0.02 * std::sin(kFrequency * (t - kBegin));
    const auto stamp = static_cast<Stamp>(1e9 * (10.0 + t));
    streams.joint_stamps.push_back(stamp);
    streams.joints.emplace_back(error(generator), q + error(generator), error(generator));
    streams.current_stamps.push_back(stamp);
  }
  return streams;
}

TEST(MotionSpan, RestsWhereReadingsAreNoiseAlone) {
  const MotionStreams streams = restThenMotion(6e-4);
  const MotionSpan span(streams);
  for (double time = 0.1; time < kBegin - 0.1; time += 0.01) {
    EXPECT_TRUE(restsAt(span, time, kLeastSpeed)) << time;
  }
  int resting = 0;
  int times = 0;
  for (double time = kBegin + 0.1; time < 3.9; time += 0.01) {
    resting += restsAt(span, time, kLeastSpeed) ? 1 : 0;
    ++times;
  }
  // Where it turns back it is slow for a moment.
  EXPECT_LT(resting, times / 5);
}

TEST(MotionSpan, DoesNotRestBeyondItsReadings) {
  const MotionStreams streams = restThenMotion(0.0);
  const MotionSpan span(streams);
  EXPECT_FALSE(restsAt(span, -1.0, kLeastSpeed));
  EXPECT_FALSE(restsAt(span, 5.0, kLeastSpeed));
}

}  // namespace
}  // namespace sac
