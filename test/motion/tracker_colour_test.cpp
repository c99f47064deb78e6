#include "tracker_colour.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace sac {
namespace {

WindowMeansMisfit meansWith(double reduced, double alike) {
  WindowMeansMisfit means;
  means.freedom = 230.0;
  means.squares = reduced * means.freedom;
  means.next_alike = alike;
  means.alike = std::abs(alike);
  return means;
}

TEST(TrackerColour, IsTheMisfitOfMeansThatAreNotAlike) {
  EXPECT_NEAR(trackerColour(meansWith(9.0, 0.0)), 9.0, 1e-12);
  EXPECT_NEAR(trackerColour(meansWith(9.0, -0.1)), 9.0, 1e-12);
  EXPECT_NEAR(trackerColour(meansWith(9.0, 0.2)), 9.0 * 1.2 / 0.8, 1e-12);
}

TEST(TrackerColour, IsWhiteWhereMeansAreAsChanceMakesThem) {
  EXPECT_EQ(trackerColour({}), 1.0);
  EXPECT_EQ(trackerColour(meansWith(1.1, 0.0)), 1.0);
  EXPECT_EQ(trackerColour(meansWith(0.5, 0.0)), 1.0);
  // Readings of joints make as much of them.
  WindowMeansMisfit shared = meansWith(4.0, 0.0);
  shared.expected = 4.0;
  EXPECT_EQ(trackerColour(shared), 1.0);
}

TEST(TrackerColour, IsNoDrift) {
  EXPECT_EQ(trackerColour(meansWith(9.0, 0.5)), 1.0);
  EXPECT_EQ(trackerColour(meansWith(900.0, 0.95)), 1.0);
  // A small one beside white noise: what is more than that is alike.
  EXPECT_EQ(trackerColour(meansWith(1.5, 0.3)), 1.0);
  EXPECT_EQ(trackerColour(meansWith(1.35, 0.0)), 1.0);
  // It comes back with the motion.
  WindowMeansMisfit periodic = meansWith(9.0, 0.0);
  periodic.alike = 0.6;
  EXPECT_EQ(trackerColour(periodic), 1.0);
}

TEST(MeansMisfit, IsTheOneThatChanceMakesOnceInAThousandTimes) {
  EXPECT_FALSE(WindowMeansMisfit().isMisfit());
  EXPECT_FALSE(meansWith(1.28, 0.0).isMisfit());
  EXPECT_TRUE(meansWith(1.33, 0.0).isMisfit());
}

}  // namespace
}  // namespace sac
