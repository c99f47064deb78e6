#include "spherical_actuator_calibration/streams/arrival_watch.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kBetweenLooks = 0.05;  // [s]
constexpr double kTolerance = 1e-9;

TEST(ArrivalWatch, CountsFromTheLastArrival) {
  ArrivalWatch watch(0, 100.0);
  EXPECT_FALSE(watch.look(0, 100.0 + kBetweenLooks));
  EXPECT_TRUE(watch.look(3, 100.0 + 2.0 * kBetweenLooks));
  EXPECT_EQ(watch.silence(), 0.0);
  for (int n = 3; n < 63; ++n) {
    EXPECT_FALSE(watch.look(3, 100.0 + n * kBetweenLooks));
  }
  EXPECT_NEAR(watch.silence(), 60.0 * kBetweenLooks, kTolerance);
}

TEST(ArrivalWatch, DoesNotCountWhileTheProcessStoodStill) {
  ArrivalWatch watch(0, 0.0);
  EXPECT_TRUE(watch.look(1, kBetweenLooks));
  EXPECT_FALSE(watch.look(1, 20.0));
  EXPECT_NEAR(watch.silence(), ArrivalWatch::kLongestStep, kTolerance);
  EXPECT_TRUE(watch.look(1000, 20.0 + kBetweenLooks));
  EXPECT_EQ(watch.silence(), 0.0);
}

}  // namespace
}  // namespace sac
