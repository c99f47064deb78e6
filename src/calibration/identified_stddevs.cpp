#include "spherical_actuator_calibration/calibration/identified_stddevs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sac {
namespace {

/// Derivatives of one gain by the coordinates of effects that it depends on.
using Gradient = std::vector<std::pair<Eigen::Index, double>>;

/// gain = nominal (1 + common) (1 + own)
Gradient poleGainGradient(const ParameterSpace& space, const Eigen::VectorXd& x, std::size_t pole) {
  const EffectLayout& effects = space.effects();
  const bool has_common = effects.has(LaboratoryEffect::kStrengthScale);
  const bool has_own = effects.has(LaboratoryEffect::kPoleGains);
  const Eigen::Index common = space.effect() + effects.first(LaboratoryEffect::kStrengthScale);
  const Eigen::Index own = space.effect() + effects.first(LaboratoryEffect::kPoleGains) +
                           static_cast<Eigen::Index>(pole);
  const double nominal = space.nominal().poles[pole].gain;
  Gradient gradient;
  if (has_common) {
    gradient.emplace_back(common, nominal * (has_own ? 1.0 + x[own] : 1.0));
  }
  if (has_own) {
    gradient.emplace_back(own, nominal * (has_common ? 1.0 + x[common] : 1.0));
  }
  return gradient;
}

Gradient coilGainGradient(const ParameterSpace& space, std::size_t coil) {
  const EffectLayout& effects = space.effects();
  if (!effects.has(LaboratoryEffect::kCoilGains) || coil < effects.coilsWithoutGain()) {
    return {};
  }
  const auto place = static_cast<Eigen::Index>(coil - effects.coilsWithoutGain());
  return {{space.effect() + effects.first(LaboratoryEffect::kCoilGains) + place,
           space.nominal().coils[coil].gain}};
}

std::optional<double> gainStddev(const CalibrationState& state, const Gradient& gradient) {
  const bool is_identified =
      !gradient.empty() && std::all_of(gradient.begin(), gradient.end(), [&](const auto& term) {
        return state.identified[static_cast<std::size_t>(term.first)];
      });
  if (!is_identified) {
    return std::nullopt;
  }
  double variance = 0.0;
  for (const auto& [p, d_p] : gradient) {
    for (const auto& [q, d_q] : gradient) {
      variance += d_p * d_q * state.belief.covariance(p, q);
    }
  }
  return std::sqrt(std::max(0.0, variance));
}

}  // namespace

ParameterStddevs identifiedStddevs(const ParameterSpace& space, const CalibrationState& state) {
  const Eigen::VectorXd& x = state.belief.x;
  const Eigen::VectorXd stddevs = space.reportedStddevs(x, state.belief.covariance);
  const auto at = [&](Eigen::Index p) {
    return state.identified[static_cast<std::size_t>(p)] ? std::optional(stddevs[p]) : std::nullopt;
  };
  ParameterStddevs result;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Eigen::Index joint = space.joint(k);
    result.joints[k] = {at(joint), at(joint + 1), at(joint + 2)};
  }
  for (std::size_t i = 0; i < space.poles(); ++i) {
    const Eigen::Index pole = space.pole(i);
    result.poles.push_back(
        {at(pole), at(pole + 1), gainStddev(state, poleGainGradient(space, x, i))});
  }
  for (std::size_t j = 0; j < space.coils(); ++j) {
    const Eigen::Index coil = space.coil(j);
    result.coils.push_back({at(coil), at(coil + 1), gainStddev(state, coilGainGradient(space, j))});
  }
  return result;
}

}  // namespace sac
