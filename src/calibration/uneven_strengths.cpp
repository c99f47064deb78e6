#include "uneven_strengths.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/distributions.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"
#include "spherical_actuator_calibration/motion/silent_coils.hpp"
#include "wider_space.hpp"

namespace sac {
namespace {

/// Places of the gains of an effect, those of the second pole or coil on: all are relative to the
/// first one, as motion tells only the ratio of strength and inertia.
std::vector<Eigen::Index> gainsOf(const ParameterSpace& space, const std::string& effect) {
  const auto count =
      static_cast<Eigen::Index>(effect == effect_name::kCoilGains ? space.coils() : space.poles()) -
      1;
  std::vector<Eigen::Index> gains;
  for (const PlacedEffect& placed : space.effects().effects()) {
    for (Eigen::Index n = placed.size() - count; placed.name == effect && n < placed.size(); ++n) {
      gains.push_back(space.effect() + placed.first + n);
    }
  }
  return gains;
}

/// What a first pole has for itself is no question: others are relative to it.
void fixFirst(const ParameterSpace& space, ParameterBelief& prior) {
  for (const PlacedEffect& placed : space.effects().effects()) {
    if (placed.name == effect_name::kPoleGains &&
        placed.size() == static_cast<Eigen::Index>(space.poles())) {
      prior.covariance.row(space.effect() + placed.first).setZero();
      prior.covariance.col(space.effect() + placed.first).setZero();
    }
  }
}

/// How some gains differ from each other.
struct Differences {
  double probability = 1.0;  ///< by chance
  std::size_t number = 0;    ///< of the one that differs most, counted from 0
  double difference = 0.0;   ///< of it, from the median of all
  double stddev = 0.0;
};

Differences differencesOf(const ParameterBelief& belief, const std::vector<Eigen::Index>& gains) {
  Differences result;
  if (gains.empty()) {
    return result;
  }
  const Eigen::VectorXd values = belief.x(gains);
  const Eigen::MatrixXd covariance = belief.covariance(gains, gains);
  const Cholesky factor(covariance);
  if (!factor.isPositive()) {
    return result;
  }
  result.probability =
      chiSquareProbability(static_cast<double>(gains.size()), values.dot(factor.solve(values)));
  std::vector<double> all{0.0};
  all.insert(all.end(), values.data(), values.data() + values.size());
  const double median = medianOf(all);
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (std::abs(all[n] - median) > std::abs(result.difference)) {
      result.number = n;
      result.difference = all[n] - median;
    }
  }
  // The first one is what the others are relative to.
  const Eigen::VectorXd variances = covariance.diagonal();
  result.stddev =
      std::sqrt(result.number == 0 ? variances.minCoeff()
                                   : variances[static_cast<Eigen::Index>(result.number) - 1]);
  return result;
}

/// The same problem with gains beside what it has.
MotionEstimate withGains(const MotionProblem& problem,
                         const Eigen::VectorXd& x,
                         const CalibrationModel& wide,
                         const std::vector<std::size_t>& silent,
                         const CalibrationConfig& config) {
  const ParameterSpace& space = wide.space();
  const std::vector<Eigen::Index> places = placesIn(space, problem.model->space());
  MotionProblem further;
  further.model = &wide;
  further.recording = problem.recording;
  further.prior = widened(problem.prior, places, nominalState(space, config.tolerance).belief);
  fixFirst(space, further.prior);
  further.start = further.prior.x;
  further.start(places) = x;
  std::vector<Eigen::Index> free;
  for (const Eigen::Index p : problem.free) {
    free.push_back(places[static_cast<std::size_t>(p)]);
  }
  for (const char* effect : {effect_name::kCoilGains, effect_name::kPoleGains}) {
    const std::vector<Eigen::Index> gains = gainsOf(space, effect);
    free.insert(free.end(), gains.begin(), gains.end());
  }
  std::sort(free.begin(), free.end());
  const std::vector<Eigen::Index> untold = coordinatesOfCoils(space, silent);
  std::set_difference(
      free.begin(), free.end(), untold.begin(), untold.end(), std::back_inserter(further.free));
  MotionOptions options;
  options.hold_out_every = 0;
  options.most_windows = 160;
  return estimateMotion(further, config.estimation, options);
}

}  // namespace

UnevenStrengths unevenStrengths(const MotionProblem& problem,
                                const Eigen::VectorXd& x,
                                const std::vector<std::size_t>& silent,
                                const CalibrationConfig& config) {
  constexpr double kSignificance = 1e-5;
  EffectSelection selection = withMotionEffects(config.effects);
  selection[effect_name::kCoilGains] = true;
  selection[effect_name::kPoleGains] = true;
  const CalibrationModel wide(ParameterSpace(problem.model->space().nominal(), selection));
  const MotionEstimate found = withGains(problem, x, wide, silent, config);
  if (found.estimate.termination != Termination::kConverged) {
    return {};
  }
  const ParameterBelief& belief = found.estimate.belief;
  const Differences coils = differencesOf(belief, gainsOf(wide.space(), effect_name::kCoilGains));
  const Differences poles = differencesOf(belief, gainsOf(wide.space(), effect_name::kPoleGains));
  const bool are_coils = coils.probability <= poles.probability;
  const Differences& worst = are_coils ? coils : poles;
  if (worst.probability > kSignificance) {
    return {};
  }
  constexpr double kPercent = 100.0;
  constexpr double kStandsOut = 6.0;  // standard deviations
  UnevenStrengths uneven;
  uneven.stands_out = std::abs(worst.difference) > kStandsOut * worst.stddev;
  uneven.words = format(
      "The motion fits better where %s differ in strength, %s %zu by %.2g +- %.2g %% from the "
      "others: that may bias the parameters. Model %s, or check %s, torque curve%s.",
      are_coils ? "coils" : "poles",
      are_coils ? "coil" : "pole",
      static_cast<std::size_t>(numberOf(worst.number)),
      kPercent * worst.difference,
      kPercent * worst.stddev,
      are_coils ? effect_name::kCoilGains : effect_name::kPoleGains,
      are_coils ? "amplifiers" : "magnets",
      uneven.stands_out ? " and friction" : ", friction and the clock that stamps the currents");
  return uneven;
}

}  // namespace sac
