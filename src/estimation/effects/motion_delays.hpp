#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// By how much later than the currents act they are stamped, by the clock of the joints.
class CurrentDelay final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kCurrentDelay;
  static constexpr auto kUnit = "s";
  static constexpr ActsOn kActsOn = ActsOn::kMotion;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  CurrentDelay(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({kName}, 0.1) {}
};

/// c of I + c Ï, what acts where I is measured: beside its delay, what a filter of second moment 2c
/// between both does to slow currents. A lag of first order that the measurement does not have
/// adds half its square.
class CurrentDispersion final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kCurrentDispersion;
  static constexpr auto kUnit = "s²";
  static constexpr ActsOn kActsOn = ActsOn::kMotion;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  CurrentDispersion(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({kName}, 1e-4) {}
};

/// By how much later than it was measured an orientation is stamped, by the clock of the joints.
class TrackerDelay final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kTrackerDelay;
  static constexpr auto kUnit = "s";
  static constexpr ActsOn kActsOn = ActsOn::kMotion;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kTracker;

  TrackerDelay(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({kName}, 0.1) {}
};

}  // namespace sac::effects
