#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {
namespace {

TEST(CurrentTolerance, ACoilThatCarriesItsCurrentIsExcitedAndOneThatIsOffIsNot) {
  for (const double threshold : {0.01, kExcitationThreshold, 0.3}) {
    const CurrentTolerance tolerance = currentTolerance(threshold);
    EXPECT_TRUE(isExcited(threshold, threshold) && isExcited(-threshold, threshold));
    EXPECT_FALSE(isExcited(0.999 * threshold, threshold));
    EXPECT_FALSE(tolerance.allows(threshold, 0.0));
    EXPECT_TRUE(tolerance.allows(0.79 * threshold, 0.0));
    for (const double command : {leastExcitation(threshold), 3.0 * threshold, 100.0 * threshold}) {
      EXPECT_FALSE(tolerance.allows(0.999 * threshold, command));
      EXPECT_FALSE(tolerance.allows(-command, command));
      EXPECT_TRUE(tolerance.allows(command, command));
    }
  }
}

TEST(CurrentTolerance, ATenthOfTheCommandMayBeMissing) {
  const CurrentTolerance tolerance = currentTolerance(kExcitationThreshold);
  EXPECT_TRUE(tolerance.allows(-1.81, -2.0));
  EXPECT_FALSE(tolerance.allows(-1.79, -2.0));
}

}  // namespace
}  // namespace sac
