#include <limits>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {
namespace {

TEST(ResidualPace, IsImprobableWhereSlowOnesAreLarger) {
  EXPECT_NEAR(ResidualPace({1.0, 1.0, 700.0}).probability(), 0.5, 1e-12);
  EXPECT_GT(ResidualPace({1.1, 1.0, 700.0}).probability(), 0.05);
  EXPECT_LT(ResidualPace({1.4, 1.0, 700.0}).probability(), 1e-5);
  EXPECT_GT(ResidualPace({1.0, 1.4, 700.0}).probability(), 0.99999);
}

TEST(ResidualPace, TellsNothingWithoutWindowsOrResiduals) {
  EXPECT_EQ(ResidualPace().probability(), 1.0);
  EXPECT_EQ(ResidualPace({1.0, 0.0, 700.0}).probability(), 1.0);
  EXPECT_EQ(ResidualPace({0.0, 0.0, 700.0}).probability(), 1.0);
  EXPECT_EQ(ResidualPace({std::numeric_limits<double>::quiet_NaN(), 1.0, 9.0}).probability(), 1.0);
}

}  // namespace
}  // namespace sac
