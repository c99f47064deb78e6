#pragma once

#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// c of T = c × Rᵀ(−z): weight of the rotor times its centre of gravity, rotor frame.
class RotorUnbalance final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kRotorUnbalance;
  static constexpr auto kUnit = "N·m";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kLoad;

  RotorUnbalance(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect(components(kName), 0.3) {}

  void addLoadColumns(const Eigen::Matrix3d& R_rotor_stator, Columns columns) const override {
    columns = -skew(R_rotor_stator * down());  // c × g = −ĝ c
  }
  Eigen::Matrix3d loadRotation(const Values& values,
                               const Eigen::Matrix3d& R_rotor_stator) const override {
    // T = ĉ Rᵀ g⁰, and e^{−ξ̂} g⁰ ≈ g⁰ + ĝ⁰ ξ.
    return skew(Eigen::Vector3d(values)) * R_rotor_stator * skew(down());
  }
  void applyTo(Actuator& actuator, const Values& values) const override {
    // Observations count all of it as unknown, whatever the description knew before.
    if (!values.isZero(0.0)) {
      actuator.unbalance = values;
    }
  }

 private:
  /// Direction of gravity, stator frame.
  static Eigen::Vector3d down() { return -Eigen::Vector3d::UnitZ(); }
};

}  // namespace sac::effects
