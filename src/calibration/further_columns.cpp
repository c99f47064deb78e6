#include "further_columns.hpp"

#include <algorithm>
#include <vector>

namespace sac {
namespace {

/// The effects that an actuator can have and the problem does not model.
EffectSelection missingEffects(const ParameterSpace& space) {
  EffectSelection missing;
  for (const std::string& effect : effectNames()) {
    const std::vector<PlacedEffect>& own = space.effects().effects();
    const bool is_modelled = std::any_of(
        own.begin(), own.end(), [&](const PlacedEffect& one) { return one.name == effect; });
    if (!is_modelled && canHaveEffect(space.nominal(), effect)) {
      missing[effect] = true;
    }
  }
  missing.setOneByOne();
  return missing;
}

}  // namespace

FurtherColumns::FurtherColumns(const CalibrationModel& model)
    : own_(model.space()), model_(ParameterSpace(own_.nominal(), missingEffects(own_))) {}

Eigen::Index FurtherColumns::first(const std::string& effect) const {
  for (const PlacedEffect& placed : own_.effects().effects()) {
    if (placed.name == effect) {
      return own_.effect() + placed.first;
    }
  }
  for (const PlacedEffect& placed : model_.space().effects().effects()) {
    if (placed.name == effect) {
      return this->effect(placed.first);
    }
  }
  return -1;
}

}  // namespace sac
