#include "spherical_actuator_calibration/emulation/stream_schedule.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"

namespace sac {
namespace {

constexpr double kDuration = 50.0;
constexpr std::uint64_t kScheduleSeed = 5;

std::vector<ScheduledMeasurement> scheduleOf(const StreamOptions& options) {
  std::vector<ScheduledMeasurement> measurements;
  for (StreamSchedule schedule(options, kDuration, kScheduleSeed, RandomPurpose::kJointStream);
       !schedule.done();
       schedule.advance()) {
    measurements.push_back(schedule.next());
  }
  return measurements;
}

TEST(StreamSchedule, KeepsTheRate) {
  StreamOptions options;
  options.rate = 120.0;
  options.phase = 0.001;
  const auto measurements = scheduleOf(options);
  EXPECT_EQ(measurements.size(), 6000U);
  EXPECT_EQ(measurements[0].since_begin, std::llround((0.5 / 120.0 + 0.001) * 1e9));
  for (std::size_t n = 1; n < measurements.size(); ++n) {
    EXPECT_NEAR(secondsBetween(measurements[n - 1].since_begin, measurements[n].since_begin),
                1.0 / 120.0,
                2e-9);
    EXPECT_FALSE(measurements[n].glitch || measurements[n].repeated ||
                 measurements[n].not_a_number);
  }
}

TEST(StreamSchedule, JitterKeepsStampsInOrder) {
  StreamOptions options;
  options.rate = 200.0;
  options.jitter = 0.00249;
  const auto measurements = scheduleOf(options);
  double largest = 0.0;
  for (std::size_t n = 1; n < measurements.size(); ++n) {
    ASSERT_LT(measurements[n - 1].since_begin, measurements[n].since_begin);
    const double beat = (static_cast<double>(n) + 0.5) / 200.0;
    largest = std::max(largest, std::abs(secondsBetween(0, measurements[n].since_begin) - beat));
  }
  EXPECT_LT(largest, 0.00249 + 1e-9);
  EXPECT_GT(largest, 0.0024);
}

TEST(StreamSchedule, DropoutsAreSpansOfSilence) {
  StreamOptions options;
  options.dropouts = 3;
  options.dropout_duration = 0.7;
  const auto measurements = scheduleOf(options);
  int silences = 0;
  for (std::size_t n = 1; n < measurements.size(); ++n) {
    const double gap = secondsBetween(measurements[n - 1].since_begin, measurements[n].since_begin);
    if (gap > 0.02) {
      ++silences;
      EXPECT_NEAR(gap, 0.7, 0.02);
    }
  }
  EXPECT_EQ(silences, 3);
  EXPECT_NEAR(static_cast<double>(measurements.size()), 5000.0 - 3 * 70.0, 3.0);
}

TEST(StreamSchedule, GlitchesComeAsManyAsAsked) {
  StreamOptions options;
  options.glitches = 40;
  int glitches = 0;
  for (const ScheduledMeasurement& measurement : scheduleOf(options)) {
    glitches += measurement.glitch ? 1 : 0;
  }
  EXPECT_EQ(glitches, 40);
}

TEST(StreamSchedule, SharesOfDefectsAreKept) {
  StreamOptions options;
  options.repeated_share = 0.1;
  options.nan_share = 0.02;
  int repeated = 0;
  int not_a_number = 0;
  for (const ScheduledMeasurement& measurement : scheduleOf(options)) {
    repeated += measurement.repeated ? 1 : 0;
    not_a_number += measurement.not_a_number ? 1 : 0;
  }
  // Within four standard deviations of 5000 draws.
  EXPECT_NEAR(repeated, 500, 85);
  EXPECT_NEAR(not_a_number, 100, 40);
}

TEST(StreamSchedule, RefusesOptionsThatCannotBe) {
  const auto refused = [](void (*change)(StreamOptions&)) {
    StreamOptions options;
    change(options);
    EXPECT_THROW(validate("tracker", options), ConfigError);
  };
  EXPECT_NO_THROW(validate("tracker", StreamOptions{}));
  refused([](StreamOptions& options) { options.rate = 0.0; });
  refused([](StreamOptions& options) { options.jitter = 0.005; });
  refused([](StreamOptions& options) { options.phase = -0.1; });
  refused([](StreamOptions& options) { options.dropout_duration = -1.0; });
  refused([](StreamOptions& options) { options.repeated_share = 1.1; });
  refused([](StreamOptions& options) { options.nan_share = -0.1; });
}

}  // namespace
}  // namespace sac
