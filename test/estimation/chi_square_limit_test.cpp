#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"

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

}  // namespace
}  // namespace sac
