#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Rotation vector of the tracker in the stator, stator frame.
class TrackerRegistration final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kTrackerRegistration;
  static constexpr auto kUnit = "rad";
  static constexpr ActsOn kActsOn = ActsOn::kOrientations;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kTracker;

  TrackerRegistration(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect(components(kName), 1.0) {}

  void addTrackerColumns(Columns columns) const override { columns.setIdentity(); }
};

}  // namespace sac::effects
