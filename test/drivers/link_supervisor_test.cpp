#include "spherical_actuator_calibration/drivers/link_supervisor.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(LinkSupervisor, WaitsLongerAfterEachFailureUpToALimit) {
  LinkSupervisor link({0.1, 0.5});
  EXPECT_TRUE(link.mayTry(0.0));
  double now = 0.0;
  for (const double pause : {0.1, 0.2, 0.4, 0.5, 0.5}) {
    link.failure(now, "no answer");
    EXPECT_FALSE(link.mayTry(now + 0.99 * pause));
    now += pause;
    EXPECT_TRUE(link.mayTry(now));
  }
  EXPECT_EQ(link.failures(), 5U);
  EXPECT_EQ(link.lastError(), "no answer");
}

TEST(LinkSupervisor, BeginsAnewAfterASuccess) {
  LinkSupervisor link({0.1, 0.5});
  link.success();
  EXPECT_TRUE(link.isUp());
  EXPECT_EQ(link.reconnects(), 0U);
  link.failure(1.0, "gone");
  link.failure(1.1, "gone");
  EXPECT_FALSE(link.isUp());
  link.success();
  EXPECT_EQ(link.reconnects(), 1U);
  link.failure(2.0, "gone");
  EXPECT_TRUE(link.mayTry(2.11));
}

}  // namespace
}  // namespace sac
