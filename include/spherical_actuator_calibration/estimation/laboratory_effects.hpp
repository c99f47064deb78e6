#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/estimation/effect_selection.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effect.hpp"

namespace sac {

/// torque_bias, rotor_unbalance and so on: as in configurations, in the order of coordinates.
const std::vector<std::string>& effectNames();

/// The selected ones, and what moves a free rotor beside its coils: inertia, unbalance, friction,
/// and delays of the streams. Where a common strength is selected the inertia stays at its nominal
/// value: motion tells only their ratio.
EffectSelection withMotionEffects(EffectSelection selection);

/// The modelled ones among them, in the same order.
std::vector<std::string> modelledEffects(const EffectSelection& selection);

/// Whether an actuator can have an effect of this name: not without the joints, or the poles, coils
/// and torque curve, that it acts on. Throws ConfigError when there is no such effect.
bool canHaveEffect(const Actuator& actuator, const std::string& effect);

/// Whether motion tells an effect of this name beside those that it always models. It uses no
/// force/torque sensor and needs no tracker, and knows a common strength only by its ratio to
/// inertia. Throws ConfigError when there is no such effect.
bool isToldByMotion(const std::string& effect);

/// "torque_bias, coil_gains", or "none".
std::string describe(const EffectSelection& selection);

/// One effect and the place of its coordinates.
struct PlacedEffect {
  std::string name;
  std::string unit;  ///< of its values, in SI: rad, N·m, kg·m² and so on, or 1
  LaboratoryEffect::ActsOn acts_on = LaboratoryEffect::ActsOn::kEverything;
  LaboratoryEffect::BelongsTo belongs_to = LaboratoryEffect::BelongsTo::kActuator;
  Eigen::Index first = 0;  ///< among the coordinates of all effects
  std::shared_ptr<const LaboratoryEffect> effect;
  double stddev = 0.0;  ///< of each value, as stated beforehand; 0: nothing is known

  Eigen::Index size() const { return effect->size(); }
};

/// Coordinates of the modelled effects: which there are, what they are called, and their scale.
/// A coordinate is the effect's value over its scale.
class EffectLayout {
 public:
  EffectLayout() = default;
  /// Throws ConfigError when there is no effect of a selected name, or one needs poles, coils and a
  /// torque curve and there are none.
  EffectLayout(const Actuator& nominal, const EffectSelection& selection);

  const std::vector<PlacedEffect>& effects() const { return effects_; }
  Eigen::Index size() const { return size_; }
  /// Place of the first coordinate of an effect. Throws DataError when it is not modelled.
  Eigen::Index first(const std::string& effect) const;
  /// The effect that a coordinate belongs to. Throws DataError when there is none.
  const PlacedEffect& at(Eigen::Index coordinate) const;

  /// torque_bias/x, pole_3/gain, coil_7/gain, joint_3/cos_1, torque_curve/t2 and so on.
  const std::string& name(Eigen::Index coordinate) const;
  /// Variance of a coordinate as stated beforehand; 0: nothing is known.
  double statedVariance(Eigen::Index coordinate) const;
  /// Covariance of all coordinates as stated beforehand; zero where nothing is known.
  const Eigen::MatrixXd& statedCovariance() const { return stated_covariance_; }
  /// Value of the effect per coordinate.
  double scale(Eigen::Index coordinate) const { return at(coordinate).effect->scale(); }
  /// Value of the effect where its coordinate is zero.
  double nominalValue(Eigen::Index coordinate) const;
  /// Values of one effect at coordinates of all effects.
  static Eigen::VectorXd values(const PlacedEffect& placed, const double* coordinates);

 private:
  void stateTogether(const StatedTogether& stated);

  std::vector<PlacedEffect> effects_;
  Eigen::MatrixXd stated_covariance_;
  Eigen::Index size_ = 0;
};

}  // namespace sac
