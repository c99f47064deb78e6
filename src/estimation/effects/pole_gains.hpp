#pragma once

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"
#include "strength_reference.hpp"

namespace sac::effects {

/// Relative change of the strength of each pole. Where another effect tells how strong all are, the
/// first pole has none: it is the reference of strength.
class PoleGains final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kPoleGains;
  static constexpr auto kUnit = "1";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  PoleGains(const Actuator& nominal, const EffectSelection& selection)
      : LaboratoryEffect(gainNames(nominal, firstPole(nominal, selection)), 1.0),
        first_pole_(firstPole(nominal, selection)) {}

  Eigen::Index strengthCoordinate(std::size_t pole, std::size_t /*coil*/) const override {
    return static_cast<Eigen::Index>(pole) - static_cast<Eigen::Index>(first_pole_);
  }
  void applyTo(Actuator& actuator, const Values& values) const override {
    for (std::size_t n = 0; n < names().size(); ++n) {
      actuator.poles[first_pole_ + n].gain *= 1.0 + values[static_cast<Eigen::Index>(n)];
    }
  }

 private:
  static std::size_t firstPole(const Actuator& nominal, const EffectSelection& selection) {
    return hasStrengthOfCurve(nominal, selection) ? 1 : 0;
  }
  static std::vector<std::string> gainNames(const Actuator& nominal, std::size_t first_pole) {
    std::vector<std::string> names;
    for (std::size_t i = first_pole; i < nominal.poles.size(); ++i) {
      names.push_back("pole_" + std::to_string(numberOf(i)) + "/gain");
    }
    return names;
  }

  std::size_t first_pole_;  ///< that has a gain
};

}  // namespace sac::effects
