#include <gtest/gtest.h>

#include "spherical_actuator_calibration/streams/stamp_filter.hpp"
#include "spherical_actuator_calibration/streams/stream_statistics.hpp"
#include "streams/example_stamps.hpp"

namespace sac {
namespace {

TEST(StampFilter, AcceptsWhatFollows) {
  StampFilter filter{StampFilterOptions()};
  for (int i = 0; i < 100; ++i) {
    const StampFilter::Verdict verdict = filter.judge(kNow + i * kPeriod);
    EXPECT_FALSE(verdict.drop);
    EXPECT_FALSE(verdict.gap);
    EXPECT_FALSE(verdict.clock_reset);
  }
}

TEST(StampFilter, DropsUnstampedRepeatedAndLate) {
  StampFilter filter{StampFilterOptions()};
  EXPECT_EQ(filter.judge(0).drop, DropReason::kUnstamped);
  EXPECT_EQ(filter.judge(-kSecond).drop, DropReason::kUnstamped);
  EXPECT_FALSE(filter.judge(kNow).drop);
  EXPECT_EQ(filter.judge(kNow).drop, DropReason::kRepeated);
  EXPECT_EQ(filter.judge(kNow - kPeriod).drop, DropReason::kLate);
  EXPECT_EQ(filter.judge(kNow - kSecond + 1).drop, DropReason::kLate);
  EXPECT_FALSE(filter.judge(kNow + kPeriod).drop);
}

TEST(StampFilter, CountsAHoleAsAGap) {
  StampFilter filter{StampFilterOptions()};
  filter.judge(kNow);
  EXPECT_FALSE(filter.judge(kNow + kSecond / 4).gap);
  EXPECT_TRUE(filter.judge(kNow + kSecond / 2 + 1).gap);
}

TEST(StampFilter, OneWrongStampCostsOneMeasurement) {
  for (const Stamp wrong : {kNow - 100 * kSecond, kNow + 100 * kSecond, Stamp{1}}) {
    StampFilter filter{StampFilterOptions()};
    filter.judge(kNow);
    EXPECT_EQ(filter.judge(wrong).drop, DropReason::kJump);
    const StampFilter::Verdict verdict = filter.judge(kNow + kPeriod);
    EXPECT_FALSE(verdict.drop);
    EXPECT_FALSE(verdict.clock_reset);
  }
}

TEST(StampFilter, BelievesAConfirmedReset) {
  StampFilter filter{StampFilterOptions()};
  filter.judge(kNow);
  const Stamp earlier = kNow - 10 * kSecond;
  EXPECT_EQ(filter.judge(earlier).drop, DropReason::kJump);
  const StampFilter::Verdict confirmed = filter.judge(earlier + kPeriod);
  EXPECT_FALSE(confirmed.drop);
  EXPECT_TRUE(confirmed.clock_reset);
  const StampFilter::Verdict next = filter.judge(earlier + 2 * kPeriod);
  EXPECT_FALSE(next.drop);
  EXPECT_FALSE(next.clock_reset);
}

TEST(StampFilter, ResumesAfterALongSilenceWithoutReset) {
  StampFilter filter{StampFilterOptions()};
  filter.judge(kNow);
  const Stamp later = kNow + 60 * kSecond;
  EXPECT_EQ(filter.judge(later).drop, DropReason::kJump);
  const StampFilter::Verdict confirmed = filter.judge(later + kPeriod);
  EXPECT_FALSE(confirmed.drop);
  EXPECT_FALSE(confirmed.clock_reset);
  EXPECT_TRUE(confirmed.gap);
}

TEST(StampFilter, ASecondPublisherOfOldStampsNeverWins) {
  StampFilter filter{StampFilterOptions()};
  filter.judge(kNow);
  for (int i = 1; i < 50; ++i) {
    EXPECT_EQ(filter.judge(kNow - 5 * kSecond + i * kPeriod).drop, DropReason::kJump);
    EXPECT_FALSE(filter.judge(kNow + i * kPeriod).drop);
  }
}

TEST(StampFilter, RestartsInAnotherTime) {
  StampFilter filter{StampFilterOptions()};
  filter.judge(kNow);
  filter.restart();
  const StampFilter::Verdict verdict = filter.judge(kSecond);
  EXPECT_FALSE(verdict.drop);
  EXPECT_FALSE(verdict.clock_reset);
}

TEST(StreamStatistics, PutsCountsInWords) {
  StreamStatistics statistics;
  statistics.received = 12000;
  EXPECT_EQ(describe("joint_states", statistics), "joint_states: 12000 received, 0 dropped.");
  statistics.dropped[static_cast<std::size_t>(DropReason::kNotFinite)] = 2;
  statistics.dropped[static_cast<std::size_t>(DropReason::kRepeated)] = 1;
  statistics.gaps = 1;
  statistics.clock_resets = 2;
  statistics.glitches = 3;
  EXPECT_EQ(describe("joint_states", statistics),
            "joint_states: 12000 received, 3 dropped (2 not finite, 1 repeated), 1 gap, "
            "2 clock resets, 3 glitches left out of means.");
}

}  // namespace
}  // namespace sac
