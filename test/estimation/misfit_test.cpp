#include "spherical_actuator_calibration/estimation/misfit.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

// χ² of ten degrees of freedom exceeds 29.588 with a probability of 0.001.
TEST(Misfit, IsWhatNoiseBringsOnceInAThousandFits) {
  EXPECT_FALSE(isMisfit(29.58, 10.0));
  EXPECT_TRUE(isMisfit(29.60, 10.0));
  EXPECT_EQ(misfitVariance(29.58, 10.0), 1.0);
  EXPECT_DOUBLE_EQ(misfitVariance(29.60, 10.0), 2.96);
}

TEST(Misfit, IsNoneWithoutFreedom) {
  EXPECT_FALSE(isMisfit(5.0, 0.0));
  EXPECT_FALSE(isMisfit(5.0, -3.0));
  EXPECT_EQ(misfitVariance(5.0, -3.0), 1.0);
}

}  // namespace
}  // namespace sac
