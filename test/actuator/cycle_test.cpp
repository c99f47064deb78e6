#include "spherical_actuator_calibration/actuator/cycle.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(Cycle, IsFoundByItsName) {
  std::set<std::string> names;
  for (const std::string& name : cycleNames()) {
    ASSERT_TRUE(cycleNamed(name)) << name;
    EXPECT_EQ(cycleName(*cycleNamed(name)), name);
    names.insert(name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"coil", "joint", "motion", "poles", "refine"}));
  EXPECT_FALSE(cycleNamed("coils"));
}

}  // namespace
}  // namespace sac
