#include "strength_screen.hpp"

#include <algorithm>
#include <cmath>

#include "predicted_torques.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"
#include "torque_hypotheses.hpp"

namespace sac {
namespace {

constexpr std::size_t kMostTried = 2;
/// Mean of a chi-square of three degrees of freedom.
constexpr double kFits = 3.0;

struct Group {
  double misfit = 0.0;
  double count = 0.0;

  void add(double squared_misfit) {
    misfit += std::min(squared_misfit, 100.0 * kFits);
    count += 1.0;
  }
  bool fits() const { return misfit <= kFits * count; }
};

/// Whether the torques of each coil, and those that each pole exerts more than half of, fit.
bool allFit(const WiringCase& fitted, const CalibrationConfig& config) {
  std::vector<Group> groups(fitted.actuator.poles.size() + fitted.actuator.coils.size());
  for (const PredictedTorque& torque : predictTorques(fitted, config)) {
    const double misfit = (torque.measured - torque.total).squaredNorm() / torque.noise;
    const Eigen::VectorXd sizes = torque.of_pole.colwise().norm();
    for (Eigen::Index i = 0; i < sizes.size(); ++i) {
      if (2.0 * sizes[i] > sizes.sum()) {
        groups[static_cast<std::size_t>(i)].add(misfit);
      }
    }
    for (Eigen::Index j = 0; j < torque.current.size(); ++j) {
      if (isExcited(torque.current[j], config.estimation.current_threshold)) {
        groups[static_cast<std::size_t>(sizes.size() + j)].add(misfit);
      }
    }
  }
  return std::all_of(groups.begin(), groups.end(), [](const Group& one) { return one.fits(); });
}

}  // namespace

std::vector<std::pair<std::size_t, double>> outstandingStrengths(
    const ParameterSpace& space,
    const std::string& effect,
    const Eigen::VectorXd& x,
    const Eigen::MatrixXd& covariance) {
  const Eigen::Index first = space.effect() + space.effects().first(effect);
  const Eigen::Index size = space.effects().at(first - space.effect()).size();
  const std::size_t count = effect == effect_name::kPoleGains ? space.poles() : space.coils();
  // Where other strengths are modelled, the first coil is their reference and has none.
  const std::size_t first_index = count - static_cast<std::size_t>(size);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(size));
  for (Eigen::Index n = 0; n < size; ++n) {
    order[static_cast<std::size_t>(n)] = n;
  }
  const auto significance = [&](Eigen::Index n) {
    return std::abs(x[first + n]) / std::sqrt(covariance(first + n, first + n));
  };
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return significance(a) > significance(b);
  });
  std::vector<std::pair<std::size_t, double>> strengths;
  strengths.reserve(order.size());
  for (const Eigen::Index n : order) {
    strengths.emplace_back(first_index + static_cast<std::size_t>(n), 1.0 + x[first + n]);
  }
  return strengths;
}

std::vector<ScreenedCandidate> screenStrengths(const WiringCase& described,
                                               const PosteriorFit& base,
                                               const CalibrationConfig& config) {
  const WiringCase fitted{ParameterSpace(described.actuator).actuatorAt(base.x), described.samples};
  std::vector<ScreenedCandidate> candidates;
  if (allFit(fitted, config)) {
    return candidates;
  }
  for (const char* effect : {effect_name::kPoleGains, effect_name::kCoilGains}) {
    EffectSelection effects;
    effects[effect] = true;
    const ParameterSpace space(described.actuator, effects);
    const FittedStream stream = FittedStream::kTorques;
    const PosteriorFit fit =
        fitPosterior(described, {}, stream, config, ModelAllowance{}, std::nullopt, effects);
    const Eigen::MatrixXd covariance =
        posteriorCovariance(described, {}, stream, config, ModelAllowance{}, effects, fit);
    const auto strengths = outstandingStrengths(space, effect, fit.x, covariance);
    for (std::size_t n = 0; n < std::min(kMostTried, strengths.size()); ++n) {
      const auto [index, strength] = strengths[n];
      const double tolerance = config.tolerance.effect;
      const bool is_pole = std::string(effect) == effect_name::kPoleGains;
      candidates.push_back(
          {{is_pole ? poleGain(index, strength, tolerance) : coilGain(index, strength, tolerance)},
           fit.log_posterior - base.log_posterior});
    }
  }
  return candidates;
}

}  // namespace sac
