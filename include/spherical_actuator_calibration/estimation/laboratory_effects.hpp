#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// What laboratories add to the geometry of the paper (doc/method.md, Laboratory).
enum class LaboratoryEffect {
  kTorqueBias,      ///< constant torque in the rotor frame, of the force/torque sensor [N·m]
  kRotorUnbalance,  ///< c of T_g = c × Rᵀ(−z), weight times centre of gravity, rotor frame [N·m]
  kStrengthScale,  ///< common relative change of all pole–coil torques (temperature) [1]
  kPoleGains,      ///< relative change of the strength of each pole [1]
  kCoilGains,      ///< the same of each coil [1]
  kEncoderHarmonics,  ///< of joint 3: a₁ cos q + b₁ sin q + a₂ cos 2q + b₂ sin 2q added to q [rad]
  kTiltCrossAxis,  ///< 2×2 matrix times (q₁, q₂) added to (q₁, q₂): scale and cross-axis [1]
  kTorqueCurve,    ///< added to the coefficients of the torque curve [unit of the description]
  kMarkerRegistration,   ///< rotation vector of the marker in the rotor, rotor frame [rad]
  kTrackerRegistration,  ///< rotation vector of the tracker in the stator, stator frame [rad]
};
inline constexpr std::size_t kLaboratoryEffects = 10;

/// torque_bias, rotor_unbalance and so on: as in configurations and parameter names.
const char* effectName(LaboratoryEffect effect);

/// Unit of an effect's values: rad, N·m, or 1.
const char* effectUnit(LaboratoryEffect effect);

/// Effects that a calibration models; the others are taken to be absent.
struct EffectSelection {
  std::array<bool, kLaboratoryEffects> modelled = {};

  bool has(LaboratoryEffect effect) const { return modelled[static_cast<std::size_t>(effect)]; }
  bool& operator[](LaboratoryEffect effect) { return modelled[static_cast<std::size_t>(effect)]; }
  const bool& operator[](LaboratoryEffect effect) const {
    return modelled[static_cast<std::size_t>(effect)];
  }
  bool any() const;
};

/// "torque_bias, coil_gains", or "none".
std::string describe(const EffectSelection& selection);

/// Coordinates of the modelled effects: which there are, what they are called, and their scale.
///
/// A coordinate is the effect's value over its unit. Units are chosen so that coordinates compare
/// with geometric errors in rad: 0.03 is a usual, 0.05 a hardly tolerable size. Where pole gains
/// or the common scale are modelled, coil 1 has no gain: it is the reference of strength.
class EffectLayout {
 public:
  EffectLayout() = default;
  /// Throws ConfigError when an effect needs poles, coils and a torque curve and there are none.
  EffectLayout(const Actuator& nominal, const EffectSelection& selection);

  Eigen::Index size() const { return static_cast<Eigen::Index>(names_.size()); }
  bool has(LaboratoryEffect effect) const { return count(effect) > 0; }
  /// Place of an effect's first coordinate, and number of them.
  Eigen::Index first(LaboratoryEffect effect) const { return at(effect).first; }
  Eigen::Index count(LaboratoryEffect effect) const { return at(effect).count; }
  /// Number of coils, from the first, that have no gain of their own: 0 or 1.
  std::size_t coilsWithoutGain() const { return coils_without_gain_; }

  /// torque_bias/x, pole_3/gain, coil_7/gain, joint_3/cos_1, torque_curve/t2 and so on.
  const std::string& name(Eigen::Index coordinate) const {
    return names_[static_cast<std::size_t>(coordinate)];
  }
  /// Value of the effect per coordinate: its unit.
  double unit(Eigen::Index coordinate) const {
    return units_[static_cast<std::size_t>(coordinate)];
  }
  /// Coefficients that the modelled changes of the torque curve have, one column for each, in the
  /// units of the description: Chebyshev polynomials up to the degree of the curve, over its
  /// polynomial range, as high as the curve's peak. Powers of the angle would make up for each
  /// other.
  const Eigen::MatrixXd& curveShapes() const { return curve_shapes_; }
  /// The effect that a coordinate belongs to.
  LaboratoryEffect effect(Eigen::Index coordinate) const;

 private:
  struct Span {
    Eigen::Index first = 0;
    Eigen::Index count = 0;
  };
  const Span& at(LaboratoryEffect effect) const { return spans_[static_cast<std::size_t>(effect)]; }
  void add(LaboratoryEffect effect, const std::vector<std::string>& names, double unit);

  std::array<Span, kLaboratoryEffects> spans_;
  std::vector<std::string> names_;
  std::vector<double> units_;
  std::size_t coils_without_gain_ = 0;
  Eigen::MatrixXd curve_shapes_;
};

}  // namespace sac
