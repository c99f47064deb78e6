#include "spherical_actuator_calibration/planning/time_budget.hpp"

#include <chrono>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

TEST(TimeBudget, IsUpAfterItsTimeAndNotBefore) {
  const auto is_up_soon = timeIsUpAfter(0.01);
  const auto is_up_late = timeIsUpAfter(3600.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(is_up_soon());
  EXPECT_FALSE(is_up_late());
  EXPECT_FALSE(timeIsUpAfter(0.0));
}

TEST(TimeBudget, RefusesWhatIsNoTime) {
  EXPECT_THROW(timeIsUpAfter(-1.0), ConfigError);
  EXPECT_THROW(timeIsUpAfter(std::numeric_limits<double>::quiet_NaN()), ConfigError);
  EXPECT_THROW(timeIsUpAfter(std::numeric_limits<double>::infinity()), ConfigError);
}

}  // namespace
}  // namespace sac
