#pragma once

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Inertia about the centre, rotor frame, around that of the paper's rotor, which needs not be
/// close: momentum is linear in it.
class RotorInertia final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kRotorInertia;
  static constexpr auto kUnit = "kg·m²";
  static constexpr ActsOn kActsOn = ActsOn::kMotion;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  RotorInertia(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({"rotor_inertia/xx",
                          "rotor_inertia/yy",
                          "rotor_inertia/zz",
                          "rotor_inertia/xy",
                          "rotor_inertia/xz",
                          "rotor_inertia/yz"},
                         1e-3) {}

  double nominalValue(Eigen::Index n) const override {
    return n < 3 ? RigidRotor().inertia(n, n) : 0.0;
  }
};

}  // namespace sac::effects
