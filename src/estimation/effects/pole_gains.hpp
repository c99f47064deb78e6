#pragma once

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Relative change of the strength of each pole.
class PoleGains final : public LaboratoryEffect {
 public:
  static constexpr auto kName = "pole_gains";
  static constexpr auto kUnit = "1";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  PoleGains(const Actuator& nominal, const EffectSelection& /*selection*/)
      : LaboratoryEffect(gainNames(nominal), 1.0) {}

  Eigen::Index strengthCoordinate(std::size_t pole, std::size_t /*coil*/) const override {
    return static_cast<Eigen::Index>(pole);
  }
  void applyTo(Actuator& actuator, const Values& values) const override {
    for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
      actuator.poles[i].gain *= 1.0 + values[static_cast<Eigen::Index>(i)];
    }
  }

 private:
  static std::vector<std::string> gainNames(const Actuator& nominal) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < nominal.poles.size(); ++i) {
      names.push_back("pole_" + std::to_string(numberOf(i)) + "/gain");
    }
    return names;
  }
};

}  // namespace sac::effects
