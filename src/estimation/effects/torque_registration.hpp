#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Rotation vector of the force/torque sensor in the rotor, rotor frame. Orientations tell it:
/// torques follow the rotor's frame as the tracker sees it.
class TorqueRegistration final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kTorqueRegistration;
  static constexpr auto kUnit = "rad";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kTorqueSensor;

  TorqueRegistration(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect(components(kName), 1.0) {}

  void addTorqueFrameColumns(Columns columns) const override { columns.setIdentity(); }
};

}  // namespace sac::effects
