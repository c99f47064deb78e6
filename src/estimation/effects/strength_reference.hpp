#pragma once

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"

namespace sac::effects {

// How strong all pole–coil pairs together are, several effects could tell: the scale, the curve,
// poles, coils. Two of them would only be known by their product, so the first one in this order
// does, and the others are relative to it.

inline bool hasStrengthScale(const EffectSelection& selection) {
  return !selection.isOneByOne() && selection.has(effect_name::kStrengthScale);
}

/// A curve whose uncertainty the description states is known by itself.
inline bool hasStrengthOfCurve(const Actuator& nominal, const EffectSelection& selection) {
  const bool is_free = selection.has(effect_name::kTorqueCurve) && nominal.torque_curve &&
                       relativeTableStddev(nominal.torque_curve->table) == 0.0;
  return hasStrengthScale(selection) || (!selection.isOneByOne() && is_free);
}

inline bool hasStrengthOfPoles(const Actuator& nominal, const EffectSelection& selection) {
  return hasStrengthOfCurve(nominal, selection) ||
         (!selection.isOneByOne() && selection.has(effect_name::kPoleGains));
}

}  // namespace sac::effects
