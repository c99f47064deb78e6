#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Constant torque of the force/torque sensor, rotor frame.
class TorqueBias final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kTorqueBias;
  static constexpr auto kUnit = "N·m";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kTorqueSensor;

  TorqueBias(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect(components(kName), 0.3) {}

  void addLoadColumns(const Eigen::Matrix3d& /*R_rotor_stator*/, Columns columns) const override {
    columns.setIdentity();
  }
};

}  // namespace sac::effects
