#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr std::array<const char*, kLaboratoryEffects> kNames = {
    "torque_bias",
    "rotor_unbalance",
    "strength_scale",
    "pole_gains",
    "coil_gains",
    "encoder_harmonics",
    "tilt_cross_axis",
    "torque_curve",
    "marker_registration",
    "tracker_registration",
};

// Units, see EffectLayout: 0.03 of them is a usual size.
constexpr double kTorqueUnit = 0.3;    // [N·m]
constexpr double kHarmonicUnit = 0.1;  // [rad]

bool needsTorqueModel(LaboratoryEffect effect) {
  return effect <= LaboratoryEffect::kCoilGains || effect == LaboratoryEffect::kTorqueCurve;
}

std::vector<std::string> components(LaboratoryEffect effect) {
  const std::string name = effectName(effect);
  return {name + "/x", name + "/y", name + "/z"};
}

/// pole_1/gain, pole_2/gain and so on.
std::vector<std::string> gainNames(const std::string& of, std::size_t first, std::size_t last) {
  std::vector<std::string> names;
  for (std::size_t n = first; n <= last; ++n) {
    std::string name = of;
    name += std::to_string(n);
    names.push_back(name.append("/gain"));
  }
  return names;
}

/// Largest torque of the polynomial part [N·m/A].
double peakOf(const TorqueCurve& curve) {
  constexpr int kSteps = 200;
  double peak = 0.0;
  for (int n = 0; n <= kSteps; ++n) {
    peak = std::max(peak, std::abs(curve.value(curve.supportBegin() * n / kSteps)));
  }
  return peak;
}

/// See EffectLayout::curveShapes(). T_{n+1} = 2 t T_n − T_{n−1} with t = 2ψ/ψ_end − 1.
Eigen::MatrixXd chebyshevShapes(const TorqueCurveDescription& curve) {
  const auto count = static_cast<Eigen::Index>(curve.coefficients.size());
  const double slope = 2.0 / curve.support_begin;
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(count, count);
  const auto times_t = [&](Eigen::Index n) {
    Eigen::VectorXd product = -shapes.col(n);
    product.tail(count - 1) += slope * shapes.col(n).head(count - 1);
    return product;
  };
  shapes(0, 0) = 1.0;
  if (count > 1) {
    shapes.col(1) = times_t(0);
  }
  for (Eigen::Index n = 1; n + 1 < count; ++n) {
    shapes.col(n + 1) = 2.0 * times_t(n) - shapes.col(n - 1);
  }
  return peakOf(TorqueCurve(curve)) * shapes;
}

}  // namespace

const char* effectName(LaboratoryEffect effect) {
  return kNames[static_cast<std::size_t>(effect)];
}

const char* effectUnit(LaboratoryEffect effect) {
  switch (effect) {
    case LaboratoryEffect::kTorqueBias:
    case LaboratoryEffect::kRotorUnbalance:
      return "N·m";
    case LaboratoryEffect::kEncoderHarmonics:
    case LaboratoryEffect::kMarkerRegistration:
    case LaboratoryEffect::kTrackerRegistration:
      return "rad";
    default:
      return "1";
  }
}

std::string describe(const EffectSelection& selection) {
  std::string names;
  for (std::size_t e = 0; e < kLaboratoryEffects; ++e) {
    if (selection.modelled[e]) {
      names += names.empty() ? "" : ", ";
      names += kNames[e];
    }
  }
  return names.empty() ? "none" : names;
}

bool EffectSelection::any() const {
  return std::find(modelled.begin(), modelled.end(), true) != modelled.end();
}

EffectLayout::EffectLayout(const Actuator& nominal, const EffectSelection& selection) {
  using Effect = LaboratoryEffect;
  for (std::size_t e = 0; e < kLaboratoryEffects; ++e) {
    const auto effect = static_cast<Effect>(e);
    if (selection.has(effect) && needsTorqueModel(effect) && !nominal.hasTorqueModel()) {
      throw ConfigError(std::string("effects.") + effectName(effect) +
                        ": the description has no poles, coils or torque curve.");
    }
  }
  for (const Effect effect : {Effect::kTorqueBias, Effect::kRotorUnbalance}) {
    if (selection.has(effect)) {
      add(effect, components(effect), kTorqueUnit);
    }
  }
  if (selection.has(Effect::kStrengthScale)) {
    add(Effect::kStrengthScale, {"strength_scale"}, 1.0);
  }
  if (selection.has(Effect::kPoleGains)) {
    add(Effect::kPoleGains, gainNames("pole_", 1, nominal.poles.size()), 1.0);
  }
  if (selection.has(Effect::kCoilGains)) {
    const bool is_relative =
        selection.has(Effect::kPoleGains) || selection.has(Effect::kStrengthScale);
    coils_without_gain_ = is_relative ? 1 : 0;
    add(Effect::kCoilGains, gainNames("coil_", 1 + coils_without_gain_, nominal.coils.size()), 1.0);
  }
  if (selection.has(Effect::kEncoderHarmonics)) {
    add(Effect::kEncoderHarmonics,
        {"joint_3/cos_1", "joint_3/sin_1", "joint_3/cos_2", "joint_3/sin_2"},
        kHarmonicUnit);
  }
  if (selection.has(Effect::kTiltCrossAxis)) {
    add(Effect::kTiltCrossAxis,
        {"tilt_matrix/11", "tilt_matrix/12", "tilt_matrix/21", "tilt_matrix/22"},
        1.0);
  }
  if (selection.has(Effect::kTorqueCurve)) {
    curve_shapes_ = chebyshevShapes(*nominal.torque_curve);
    for (Eigen::Index n = 0; n < curve_shapes_.cols(); ++n) {
      add(Effect::kTorqueCurve, {"torque_curve/t" + std::to_string(n)}, 1.0);
    }
  }
  for (const Effect effect : {Effect::kMarkerRegistration, Effect::kTrackerRegistration}) {
    if (selection.has(effect)) {
      add(effect, components(effect), 1.0);
    }
  }
}

LaboratoryEffect EffectLayout::effect(Eigen::Index coordinate) const {
  for (std::size_t e = 0; e < kLaboratoryEffects; ++e) {
    const Span& span = spans_[e];
    if (coordinate >= span.first && coordinate < span.first + span.count) {
      return static_cast<LaboratoryEffect>(e);
    }
  }
  throw DataError("Effect coordinate " + std::to_string(coordinate) + " does not exist.");
}

void EffectLayout::add(LaboratoryEffect effect,
                       const std::vector<std::string>& names,
                       double unit) {
  Span& span = spans_[static_cast<std::size_t>(effect)];
  if (span.count == 0) {
    span.first = size();
  }
  span.count += static_cast<Eigen::Index>(names.size());
  names_.insert(names_.end(), names.begin(), names.end());
  units_.insert(units_.end(), names.size(), unit);
}

}  // namespace sac
