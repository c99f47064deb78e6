#include "si_units.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

TEST(SiUnits, AreThoseOfTheParameters) {
  EXPECT_EQ(siUnit("1"), "\\one");
  EXPECT_EQ(siUnit("rad"), "\\radian");
  EXPECT_EQ(siUnit("N·m"), "\\newton\\metre");
  EXPECT_EQ(siUnit("s"), "\\second");
  EXPECT_EQ(siUnit("s²"), "\\second\\tothe{2}");
  EXPECT_EQ(siUnit("kg·m²"), "\\kilogram\\metre\\tothe{2}");
  EXPECT_EQ(siUnit("N·m·s/rad"), "\\newton\\metre\\second\\radian\\tothe{-1}");
}

TEST(SiUnits, MultiplyForCovariances) {
  EXPECT_EQ(siProduct("1", "1"), "\\one");
  EXPECT_EQ(siProduct("1", "N·m"), "\\newton\\metre");
  EXPECT_EQ(siProduct("rad", "rad"), "\\radian\\tothe{2}");
  EXPECT_EQ(siProduct("N·m", "rad"), "\\newton\\metre\\radian");
  EXPECT_EQ(siProduct("N·m", "N·m"), "\\newton\\tothe{2}\\metre\\tothe{2}");
  EXPECT_EQ(siProduct("N·m·s/rad", "rad"), "\\newton\\metre\\second");
  EXPECT_EQ(siProduct("kg·m²", "s²"), "\\kilogram\\metre\\tothe{2}\\second\\tothe{2}");
}

TEST(SiUnits, AreKnownForEveryEffect) {
  for (const std::string& effect : effectNames()) {
    EffectSelection selection;
    selection[effect] = true;
    const EffectLayout layout(scenarios::paperNominal(), selection);
    for (const PlacedEffect& placed : layout.effects()) {
      EXPECT_NO_THROW(siUnit(placed.unit)) << effect;
    }
  }
  EXPECT_THROW(siUnit("furlong"), DataError);
}

}  // namespace
}  // namespace sac
