#pragma once

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"
#include "strength_reference.hpp"

namespace sac::effects {

/// Relative change of the strength of each coil. Where another effect tells how strong all are, the
/// first coil has none: it is the reference of strength.
class CoilGains final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kCoilGains;
  static constexpr auto kUnit = "1";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  CoilGains(const Actuator& nominal, const EffectSelection& selection)
      : LaboratoryEffect(gainNames(nominal, firstCoil(nominal, selection)), 1.0),
        first_coil_(firstCoil(nominal, selection)) {}

  bool isToldBy(Eigen::Index n, const std::vector<bool>& excited) const override {
    return excited[first_coil_ + static_cast<std::size_t>(n)];
  }
  Eigen::Index strengthCoordinate(std::size_t /*pole*/, std::size_t coil) const override {
    return static_cast<Eigen::Index>(coil) - static_cast<Eigen::Index>(first_coil_);
  }
  void applyTo(Actuator& actuator, const Values& values) const override {
    for (std::size_t n = 0; n < names().size(); ++n) {
      actuator.coils[first_coil_ + n].gain *= 1.0 + values[static_cast<Eigen::Index>(n)];
    }
  }

 private:
  static std::size_t firstCoil(const Actuator& nominal, const EffectSelection& selection) {
    return hasStrengthOfPoles(nominal, selection) ? 1 : 0;
  }
  static std::vector<std::string> gainNames(const Actuator& nominal, std::size_t first_coil) {
    std::vector<std::string> names;
    for (std::size_t j = first_coil; j < nominal.coils.size(); ++j) {
      names.push_back("coil_" + std::to_string(numberOf(j)) + "/gain");
    }
    return names;
  }

  std::size_t first_coil_;  ///< that has a gain
};

}  // namespace sac::effects
