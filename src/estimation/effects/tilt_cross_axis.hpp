#pragma once

#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// 2×2 matrix times (q₁, q₂) added to (q₁, q₂): scale and cross-axis of the tilt sensor.
class TiltCrossAxis final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kTiltCrossAxis;
  static constexpr auto kUnit = "1";
  static constexpr ActsOn kActsOn = ActsOn::kEverything;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  TiltCrossAxis(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({"tilt_matrix/11", "tilt_matrix/12", "tilt_matrix/21", "tilt_matrix/22"},
                         1.0) {}

  void addReadingColumns(const Eigen::Vector3d& reading, Columns columns) const override {
    columns.row(0).head<2>() = reading.head<2>();
    columns.row(1).tail<2>() = reading.head<2>();
  }
  void applyTo(Actuator& actuator, const Values& values) const override {
    for (Eigen::Index n = 0; n < values.size(); ++n) {
      const auto joint = static_cast<std::size_t>(n / 2);
      actuator.joints[joint].correction.linear[static_cast<std::size_t>(n % 2)] += values[n];
    }
  }
};

}  // namespace sac::effects
