#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Rotation vector of the marker in the rotor, rotor frame. Torques tell it: they are measured in
/// the rotor's frame.
class MarkerRegistration final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kMarkerRegistration;
  static constexpr auto kUnit = "rad";
  static constexpr ActsOn kActsOn = ActsOn::kOrientations;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kTracker;

  MarkerRegistration(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect(components(kName), 1.0) {}

  void addMarkerColumns(Columns columns) const override { columns.setIdentity(); }
};

}  // namespace sac::effects
