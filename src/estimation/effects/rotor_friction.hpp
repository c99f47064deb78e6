#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// b of the torque −b ω of friction on a rotor that turns with ω.
class ViscousFriction final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kViscousFriction;
  static constexpr auto kUnit = "N·m·s/rad";
  static constexpr ActsOn kActsOn = ActsOn::kMotion;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  ViscousFriction(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({kName}, 0.03) {}
};

/// c of −c ω/√(ω² + v²), with a small speed v.
class CoulombFriction final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kCoulombFriction;
  static constexpr auto kUnit = "N·m";
  static constexpr ActsOn kActsOn = ActsOn::kMotion;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  CoulombFriction(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({kName}, 0.03) {}
};

}  // namespace sac::effects
