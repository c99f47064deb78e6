#include "spherical_actuator_calibration/estimation/effect_selection.hpp"

#include <algorithm>

namespace sac {

const bool& EffectSelection::operator[](const std::string& effect) const {
  static constexpr bool kAbsent = false;
  const auto found = modelled_.find(effect);
  return found == modelled_.end() ? kAbsent : found->second;
}

bool EffectSelection::any() const {
  return std::any_of(
      modelled_.begin(), modelled_.end(), [](const auto& entry) { return entry.second; });
}

double EffectSelection::stddev(const std::string& effect) const {
  const auto found = stddevs_.find(effect);
  return found == stddevs_.end() ? 0.0 : found->second;
}

}  // namespace sac
