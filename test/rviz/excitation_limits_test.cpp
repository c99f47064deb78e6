#include "excitation_limits.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/usual_currents.hpp"

namespace sac {
namespace {

TEST(ExcitationLimits, OfferTheCurrentThatAllUse) {
  EXPECT_EQ(kOfferedCurrent, kUsualExcitation);
}

}  // namespace
}  // namespace sac
