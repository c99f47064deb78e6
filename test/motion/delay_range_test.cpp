#include "spherical_actuator_calibration/motion/delay_range.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(DelayRange, HasStepsToBothSidesOfItsMiddle) {
  const std::vector<double> delays = DelayRange{0.02, 0.035}.delays();
  ASSERT_EQ(delays.size(), 7U);
  EXPECT_NEAR(delays.front(), -0.01, 1e-12);
  EXPECT_NEAR(delays[3], 0.02, 1e-12);
  EXPECT_NEAR(delays.back(), 0.05, 1e-12);
}

TEST(DelayRange, AboutADelayStaysWithinTheRange) {
  const DelayRange all;
  for (const double delay : {-0.06, -0.03, 0.0, 0.06}) {
    const std::vector<double> delays = all.about(delay).delays();
    ASSERT_EQ(delays.size(), 3U) << delay;
    EXPECT_GE(delays.front(), all.delays().front() - 1e-12);
    EXPECT_LE(delays.back(), all.delays().back() + 1e-12);
    EXPECT_TRUE(delays.front() - 1e-12 <= delay && delay <= delays.back() + 1e-12) << delay;
  }
}

}  // namespace
}  // namespace sac
