#include "spherical_actuator_calibration/drivers/current_limiter.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

Eigen::VectorXd currents(double a, double b, double c) {
  return Eigen::Vector3d(a, b, c);
}

TEST(CurrentLimiter, FollowsWhatIsWithinTheLimits) {
  CurrentLimiter limiter({2.0, 5.0, 100.0}, 3);
  EXPECT_EQ(limiter.follow(currents(1.0, -2.0, 0.5), 1.0), currents(1.0, -2.0, 0.5));
  EXPECT_EQ(limiter.clamped(), 0U);
}

TEST(CurrentLimiter, HoldsEachCoilAndTheSumWithinTheirLimits) {
  CurrentLimiter limiter({2.0, 3.0, 1e6}, 3);
  EXPECT_EQ(limiter.follow(currents(9.0, 0.0, -0.5), 1.0), currents(2.0, 0.0, -0.5));
  const Eigen::VectorXd scaled = limiter.follow(currents(2.0, -2.0, 2.0), 1.0);
  EXPECT_NEAR(scaled.cwiseAbs().sum(), 3.0, 1e-12);
  EXPECT_LT((scaled - currents(1.0, -1.0, 1.0)).norm(), 1e-12);
  EXPECT_EQ(limiter.clamped(), 2U);
  EXPECT_EQ(limiter.limitsInWords(), "limits/coil 2 A, limits/total 3 A");
}

TEST(CurrentLimiter, MovesNoFasterThanTheSlewLimit) {
  CurrentLimiter limiter({2.0, 5.0, 10.0}, 3);
  EXPECT_LT((limiter.follow(currents(2.0, -0.5, 0.0), 0.1) - currents(1.0, -0.5, 0.0)).norm(),
            1e-12);
  EXPECT_LT((limiter.follow(currents(2.0, -0.5, 0.0), 0.05) - currents(1.5, -0.5, 0.0)).norm(),
            1e-12);
  EXPECT_EQ(limiter.follow(currents(0.0, 0.0, 0.0), -1.0), limiter.setpoints());
}

TEST(CurrentLimiter, IsWithinTheSumOnTheWayFromOnePatternToAnother) {
  CurrentLimiter limiter({2.0, 4.0, 10.0}, 3);
  limiter.follow(currents(2.0, 2.0, 0.0), 10.0);
  for (int step = 0; step < 50; ++step) {
    EXPECT_LE(limiter.follow(currents(0.0, 2.0, 2.0), 0.01).cwiseAbs().sum(), 4.0 + 1e-12);
  }
  EXPECT_LT((limiter.setpoints() - currents(0.0, 2.0, 2.0)).norm(), 1e-9);
}

TEST(CurrentLimiter, StopsAtOnce) {
  CurrentLimiter limiter({2.0, 5.0, 10.0}, 3);
  limiter.follow(currents(2.0, 1.0, 1.0), 1.0);
  EXPECT_TRUE(limiter.stop().isZero(0.0));
  EXPECT_TRUE(limiter.setpoints().isZero(0.0));
}

TEST(CurrentLimiter, NamesTheDefectOfACommand) {
  EXPECT_EQ(commandDefect(currents(0.0, 1.0, 2.0), 3), "");
  EXPECT_EQ(commandDefect(currents(0.0, 1.0, 2.0), 24), "The command has 3 currents for 24 coils.");
  EXPECT_EQ(commandDefect(currents(0.0, std::nan(""), 2.0), 3),
            "The commanded current of coil 2 is not finite.");
  EXPECT_NE(commandDefect(currents(0.0, 0.0, std::numeric_limits<double>::infinity()), 3), "");
}

TEST(CurrentLimiter, RefusesLimitsThatAreNone) {
  EXPECT_THROW(CurrentLimiter({0.0, 5.0, 10.0}, 3), ConfigError);
  EXPECT_THROW(CurrentLimiter({2.0, -1.0, 10.0}, 3), ConfigError);
  EXPECT_THROW(CurrentLimiter({2.0, 5.0, std::nan("")}, 3), ConfigError);
}

}  // namespace
}  // namespace sac
