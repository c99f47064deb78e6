#pragma once

#include <cmath>

#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// First and second harmonic of the encoder of joint 3: a₁ cos q + b₁ sin q + a₂ cos 2q + b₂ sin 2q
/// added to its reading q.
class EncoderHarmonics final : public LaboratoryEffect {
 public:
  static constexpr auto kName = "encoder_harmonics";
  static constexpr auto kUnit = "rad";
  static constexpr ActsOn kActsOn = ActsOn::kEverything;

  EncoderHarmonics(const Actuator& /*nominal*/, const EffectSelection& /*selection*/)
      : LaboratoryEffect({"joint_3/cos_1", "joint_3/sin_1", "joint_3/cos_2", "joint_3/sin_2"},
                         0.1) {}

  void addReadingColumns(const Eigen::Vector3d& reading, Columns columns) const override {
    const double q = reading[2];
    columns.row(2) << std::cos(q), std::sin(q), std::cos(2.0 * q), std::sin(2.0 * q);
  }
};

}  // namespace sac::effects
