#pragma once

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac::effects {

/// Added to the coefficients of the torque curve: Chebyshev polynomials up to the degree of the
/// curve, over its polynomial range, as high as the curve's peak. Powers of the angle would make up
/// for each other.
class TorqueCurveChange final : public LaboratoryEffect {
 public:
  static constexpr auto kName = effect_name::kTorqueCurve;
  static constexpr auto kUnit = "1";
  static constexpr ActsOn kActsOn = ActsOn::kTorques;
  static constexpr BelongsTo kBelongsTo = BelongsTo::kActuator;

  TorqueCurveChange(const Actuator& nominal, const EffectSelection& selection);

  double priorStddev() const override { return prior_stddev_; }
  void addPairColumns(const Eigen::Vector3d& pole_rotor,
                      const Eigen::Vector3d& coil_rotor,
                      Columns columns) const override;
  bool changesCurve() const override { return true; }
  void applyTo(Actuator& actuator, const Values& values) const override;

 private:
  Eigen::MatrixXd shapes_;          ///< coefficients of a change, a column each, as described
  double prior_stddev_;             ///< of each shape, by the stated uncertainty of a table
  std::vector<TorqueCurve> basis_;  ///< the same as curves: the torque curve is linear in them
};

}  // namespace sac::effects
