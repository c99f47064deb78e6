#include "spherical_actuator_calibration/estimation/distributions.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(ChiSquareLimit, IsWhereItsProbabilityIs) {
  EXPECT_NEAR(chiSquareProbability(3.0, 7.814728), 0.05, 1e-7);
  EXPECT_NEAR(chiSquareLimit(3.0, 0.05), 7.814728, 1e-6);
  EXPECT_NEAR(chiSquareProbability(6000.0, chiSquareLimit(6000.0, 1e-5)), 1e-5, 1e-12);
}

TEST(ChiSquareLimit, NoMisfitAtAllIsSurelyReached) {
  for (const double freedom : {3.0, 6000.0, 3e5}) {
    for (const double value : {0.0, 1e-300, 1e-25, 1e-9}) {
      EXPECT_NEAR(chiSquareProbability(freedom, value), 1.0, 1e-12);
    }
  }
}

TEST(ChiSquareNonCentrality, IsWhatLeavesTheProbabilityBelow) {
  EXPECT_NEAR(chiSquareNonCentrality(6.0, 8.0, 0.01), 19.753896, 1e-5);
}

TEST(VarianceRatio, IsAsProbableAsFishersDistributionSays) {
  EXPECT_NEAR(varianceRatioProbability(1.0, 40.0, 40.0), 0.5, 1e-12);
  EXPECT_NEAR(varianceRatioProbability(3.32583, 5.0, 10.0), 0.05, 1e-6);
}

TEST(BinomialTail, CountsFromTheGivenNumberOn) {
  EXPECT_EQ(binomialTail(10, 0.1, 0), 1.0);
  EXPECT_NEAR(binomialTail(10, 0.1, 1), 1.0 - std::pow(0.9, 10), 1e-12);
  EXPECT_NEAR(binomialTail(5, 0.1, 4), 5.0 * 0.9 * 1e-4 + 1e-5, 1e-15);
}

TEST(Quantiles, OfTheNormalAndOfStudentsDistribution) {
  EXPECT_NEAR(normalQuantile(0.975), 1.959964, 1e-6);
  EXPECT_NEAR(studentQuantile(5.0, 0.975), 2.570582, 1e-6);
}

}  // namespace
}  // namespace sac
