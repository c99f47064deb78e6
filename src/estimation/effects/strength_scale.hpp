#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Common relative change of all pole–coil torques, as by the temperature of the magnets.
class StrengthScale final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kStrengthScale;
  static constexpr auto kUnit = "1";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  StrengthScale(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({kName}, 1.0) {}

  Eigen::Index strengthCoordinate(std::size_t /*pole*/, std::size_t /*coil*/) const override {
    return 0;
  }
  void applyTo(Actuator& actuator, const Values& values) const override {
    for (PoleAxis& pole : actuator.poles) {
      pole.gain *= 1.0 + values[0];
    }
  }
};

}  // namespace sac::effects
