#include "residual_alignment.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(ResidualAlignment, CountsWhereItIsMoreThanChance) {
  EXPECT_FALSE(ResidualAlignment().isMisfit());
  EXPECT_EQ(ResidualAlignment().variance(), 1.0);
  const ResidualAlignment small{1.2, 0.09};
  EXPECT_NEAR(small.limit(), 1.36, 1e-9);
  EXPECT_FALSE(small.isMisfit());
  EXPECT_EQ(small.variance(), 1.0);
  const ResidualAlignment large{1.5, 0.09};
  EXPECT_TRUE(large.isMisfit());
  EXPECT_EQ(large.variance(), 1.5);
  // Less than noise misleads nobody.
  EXPECT_EQ((ResidualAlignment{0.5, 0.01}.variance()), 1.0);
}

}  // namespace
}  // namespace sac
