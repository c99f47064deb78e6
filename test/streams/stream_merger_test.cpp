#include "spherical_actuator_calibration/streams/stream_merger.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "streams/example_stamps.hpp"

namespace sac {
namespace {

constexpr Stamp kMillisecond = kSecond / 1000;
constexpr Stamp kBegin = kNow;
constexpr double kClockReset = 1.0;  // [s]

JointMeasurement joint(Stamp stamp) {
  JointMeasurement measurement;
  measurement.stamp = stamp;
  return measurement;
}

TorqueMeasurement torque(Stamp stamp) {
  TorqueMeasurement measurement;
  measurement.stamp = stamp;
  return measurement;
}

/// Stamps of all that comes out at a time [ms from the begin].
std::vector<Stamp> taken(StreamMerger& merger, double now) {
  std::vector<Stamp> stamps;
  while (const auto measurement = merger.next(now)) {
    stamps.push_back(std::visit([](const auto& any) { return any.stamp; }, *measurement));
    stamps.back() = (stamps.back() - kBegin) / kMillisecond;
  }
  return stamps;
}

/// Lets time pass in small steps; returns what came out meanwhile.
std::vector<Stamp> takenUntil(StreamMerger& merger, double begin, double end) {
  std::vector<Stamp> stamps;
  constexpr double kStep = 0.01;  // [s]
  for (double now = begin; now < end; now += kStep) {
    const std::vector<Stamp> some = taken(merger, now);
    stamps.insert(stamps.end(), some.begin(), some.end());
  }
  return stamps;
}

/// Both streams came at the begin, so that both are waited for.
StreamMerger mergerOfTwoStreams(double clock_reset = kClockReset) {
  StreamMerger merger(clock_reset);
  merger.add(joint(kBegin), 0.0);
  merger.add(torque(kBegin), 0.0);
  while (merger.nextAtOnce()) {
  }
  return merger;
}

TEST(StreamMerger, WaitsForNoStreamThatNeverCame) {
  StreamMerger merger(kClockReset);
  merger.add(joint(kBegin), 0.0);
  EXPECT_EQ(taken(merger, 0.0), (std::vector<Stamp>{0}));
}

TEST(StreamMerger, OrdersLumpsAfterAStandstill) {
  StreamMerger merger = mergerOfTwoStreams();
  // Three seconds in which the process stood still arrive at once, one stream after the other.
  for (Stamp ms = 10; ms <= 3000; ms += 10) {
    merger.add(joint(kBegin + ms * kMillisecond), 3.0);
    EXPECT_TRUE(taken(merger, 3.0).empty());
  }
  std::vector<Stamp> stamps;
  for (Stamp ms = 10; ms <= 3000; ms += 10) {
    merger.add(torque(kBegin + ms * kMillisecond), 3.0);
    const std::vector<Stamp> some = taken(merger, 3.0);
    stamps.insert(stamps.end(), some.begin(), some.end());
  }
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
  EXPECT_GE(stamps.size(), 598U);
}

TEST(StreamMerger, PatienceWithAnotherStreamEnds) {
  StreamMerger merger = mergerOfTwoStreams();
  merger.add(joint(kBegin + 10 * kMillisecond), 0.01);
  EXPECT_TRUE(takenUntil(merger, 0.01, 0.9 * StreamMerger::kPatience).empty());
  EXPECT_EQ(takenUntil(merger, 0.9 * StreamMerger::kPatience, 1.5 * StreamMerger::kPatience),
            (std::vector<Stamp>{10}));
}

TEST(StreamMerger, DoesNotWaitForASilentStream) {
  StreamMerger merger = mergerOfTwoStreams();
  takenUntil(merger, 0.0, 1.5 * StreamMerger::kSilence);
  merger.add(joint(kBegin + 2000 * kMillisecond), 1.5 * StreamMerger::kSilence);
  EXPECT_EQ(taken(merger, 1.5 * StreamMerger::kSilence), (std::vector<Stamp>{2000}));
}

TEST(StreamMerger, KeepsTheRoundsOfALoopApart) {
  StreamMerger merger = mergerOfTwoStreams();
  merger.add(joint(kBegin + 5000 * kMillisecond), 0.01);
  merger.add(joint(kBegin + 1 * kMillisecond), 0.02);
  merger.add(joint(kBegin + 2 * kMillisecond), 0.02);
  merger.add(torque(kBegin + 5001 * kMillisecond), 0.03);
  merger.add(torque(kBegin + 1 * kMillisecond), 0.03);
  merger.add(torque(kBegin + 3 * kMillisecond), 0.03);
  EXPECT_EQ(taken(merger, 0.03), (std::vector<Stamp>{5000, 5001, 1, 1, 2}));
}

TEST(StreamMerger, ARoundBeginsWhereTheClockCountsAsReset) {
  for (const double clock_reset : {0.2, kClockReset}) {
    StreamMerger merger = mergerOfTwoStreams(clock_reset);
    merger.add(joint(kBegin + 500 * kMillisecond), 0.01);
    merger.add(joint(kBegin + 1 * kMillisecond), 0.02);
    merger.add(torque(kBegin + 502 * kMillisecond), 0.03);
    merger.add(torque(kBegin + 2 * kMillisecond), 0.03);
    const bool is_reset = clock_reset < 0.5;
    EXPECT_EQ(taken(merger, 0.03),
              is_reset ? (std::vector<Stamp>{500, 502, 1}) : (std::vector<Stamp>{500, 1}))
        << clock_reset;
  }
}

TEST(StreamMerger, OneStreamThatWasSetBackAloneDelaysNobodyForLong) {
  StreamMerger merger = mergerOfTwoStreams();
  merger.add(torque(kBegin - 5000 * kMillisecond), 0.01);
  EXPECT_EQ(takenUntil(merger, 0.01, 0.3), (std::vector<Stamp>{-5000}));
  merger.add(torque(kBegin + 300 * kMillisecond), 0.3);
  merger.add(joint(kBegin + 301 * kMillisecond), 0.3);
  merger.add(torque(kBegin + 302 * kMillisecond), 0.3);
  EXPECT_EQ(taken(merger, 0.3), (std::vector<Stamp>{300, 301}));
}

TEST(StreamMerger, UnstampedMeasurementsPassAtOnce) {
  StreamMerger merger = mergerOfTwoStreams();
  merger.add(torque(0), 0.01);
  merger.add(joint(kBegin + 10 * kMillisecond), 0.01);
  EXPECT_EQ(taken(merger, 0.01).size(), 1U);
  merger.add(torque(kBegin + 11 * kMillisecond), 0.02);
  EXPECT_EQ(taken(merger, 0.02), (std::vector<Stamp>{10}));
}

TEST(StreamMerger, GivesTheRestAtOnceWhenAsked) {
  StreamMerger merger = mergerOfTwoStreams();
  merger.add(joint(kBegin + 10 * kMillisecond), 0.01);
  EXPECT_TRUE(taken(merger, 0.01).empty());
  EXPECT_TRUE(merger.nextAtOnce().has_value());
  EXPECT_FALSE(merger.nextAtOnce().has_value());
}

}  // namespace
}  // namespace sac
