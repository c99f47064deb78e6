#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(CoilPattern, NamesCoilsFromOneWithTheirSigns) {
  EXPECT_EQ(patternText({{0, 1}, {3, -1}}), "+1 -4");
  EXPECT_EQ(patternText({}), "");
}

TEST(CoilPattern, HasEachCoilAloneAtPositiveCurrent) {
  const std::vector<CoilPattern> expected = {{{2, 1}}, {{5, 1}}};
  EXPECT_EQ(singly({2, 5}), expected);
  EXPECT_TRUE(singly({}).empty());
}

}  // namespace
}  // namespace sac
