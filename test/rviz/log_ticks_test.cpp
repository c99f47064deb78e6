#include "log_ticks.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(LogTicks, LabelWhatIsLessThanADecade) {
  EXPECT_EQ(logTicks(0.766, 0.851), (std::vector<double>{0.766, 0.851}));
  EXPECT_EQ(logTicks(0.9, 1.1), (std::vector<double>{0.9, 1.1}));
  EXPECT_EQ(logTicks(0.3, 0.3), (std::vector<double>{0.3}));
}

TEST(LogTicks, AreRoundAndFew) {
  const std::vector<double> ticks = logTicks(0.1, 2.0);
  ASSERT_EQ(ticks.size(), 5U);
  EXPECT_NEAR(ticks.front(), 0.1, 1e-12);
  EXPECT_NEAR(ticks[2], 0.5, 1e-12);
  EXPECT_NEAR(ticks.back(), 2.0, 1e-12);
  EXPECT_EQ(logTicks(1e-4, 1.0).size(), 5U);
}

TEST(LogTicks, OfManyDecadesAreSome) {
  const std::vector<double> ticks = logTicks(1e-9, 1e3);
  EXPECT_GE(ticks.size(), 4U);
  EXPECT_LE(ticks.size(), 7U);
  EXPECT_NEAR(ticks.front(), 1e-9, 1e-18);
}

}  // namespace
}  // namespace sac
