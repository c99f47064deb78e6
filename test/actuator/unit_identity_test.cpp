#include "spherical_actuator_calibration/actuator/unit_identity.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

Actuator named(const std::string& name, const std::string& serial) {
  Actuator actuator;
  actuator.name = name;
  actuator.serial = serial;
  return actuator;
}

TEST(UnitIdentity, IsOfNamesAndOfSerialsThatBothKnow) {
  EXPECT_FALSE(otherUnit(named("sphere", "unit-1"), "sphere", "unit-1"));
  EXPECT_FALSE(otherUnit(named("sphere", "unit-1"), "sphere", ""));
  EXPECT_FALSE(otherUnit(named("sphere", ""), "sphere", "unit-2"));
  EXPECT_FALSE(otherUnit(named("sphere", "unit-1"), "", "unit-1"));
}

TEST(UnitIdentity, TellsWhatDiffers) {
  const auto other_kind = otherUnit(named("sphere", "unit-1"), "globe", "unit-2");
  ASSERT_TRUE(other_kind);
  EXPECT_EQ(other_kind->kind, "actuator");
  EXPECT_EQ(other_kind->its, "globe");
  EXPECT_EQ(other_kind->own, "sphere");
  const auto other_unit = otherUnit(named("sphere", "unit-1"), "sphere", "unit-2");
  ASSERT_TRUE(other_unit);
  EXPECT_EQ(other_unit->kind, "unit");
  EXPECT_EQ(other_unit->its, "unit-2");
  EXPECT_EQ(other_unit->own, "unit-1");
}

}  // namespace
}  // namespace sac
