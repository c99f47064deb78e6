#include "spherical_actuator_calibration/assessment/model_choice.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/cholesky.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/calibration/orientation_map_choice.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"

namespace sac {
namespace {

/// Σ rᵀN⁻¹r over all observations of the refinement, and their number of values.
void sumUp(const CalibrationSession& session, ModelFit& fit) {
  const EstimationOptions& options = session.config().estimation;
  EstimationProblem problem;
  problem.model = &session.model();
  problem.samples = &session.samples();
  problem.observations =
      selectObservations(session.model().space(), session.samples(), {Cycle::kRefine}, options);
  problem.prior = session.state().belief;
  const ObservationEvaluator evaluator(problem, options);
  const ModelPoint point = evaluator.at(problem.prior.x);
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, point, linear);
    fit.chi_square +=
        linear.residual.dot(Cholesky3(evaluator.noise(n, linear)).solve(linear.residual));
    fit.values += 3;
  }
}

/// Whether an effect makes a difference to orientations.
bool concernsOrientations(const EffectSelection& effects, const Actuator& nominal) {
  const EffectLayout layout(nominal, effects);
  return std::any_of(
      layout.effects().begin(), layout.effects().end(), [](const PlacedEffect& placed) {
        return placed.acts_on != LaboratoryEffect::ActsOn::kTorques;
      });
}

/// Error of the orientations of regions that take no part in the refinement; from orientations
/// alone, which is quick.
std::optional<double> heldOutError(const CalibrationSession& session) {
  constexpr int kDepth = 3;
  constexpr std::size_t kFewest = 30;
  std::vector<Eigen::Vector3d> readings;
  for (const Sample& sample : session.samples()) {
    readings.push_back(sample.joint_position);
  }
  const std::vector<std::size_t> regions = regionsOf(readings, kDepth);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t region = 0; region < (std::size_t{1} << static_cast<unsigned>(kDepth));
       ++region) {
    std::vector<Sample> others = session.samples();
    for (std::size_t n = 0; n < others.size(); ++n) {
      others[n].validation = others[n].validation || regions[n] == region;
      others[n].has_torque = false;
    }
    const CycleOutcome outcome = runCycle(session.model(),
                                          others,
                                          session.state(),
                                          withoutExpectedErrors({Cycle::kRefine}),
                                          session.config().estimation);
    const ModelPoint point(session.model(), outcome.state.belief.x);
    for (std::size_t n = 0; outcome.report.success && n < others.size(); ++n) {
      const Sample& sample = session.samples()[n];
      if (regions[n] == region && session.model().observesOrientation(sample) &&
          !sample.validation) {
        sum += point.orientationResidual(sample).squaredNorm();
        ++count;
      }
    }
  }
  return count < kFewest ? std::nullopt
                         : std::optional(std::sqrt(sum / static_cast<double>(count)));
}

/// Effects with coordinates that a refinement leaves open.
std::vector<std::string> notTold(const ParameterSpace& space, const CycleReport& refined) {
  std::vector<std::string> effects;
  for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
    const bool is_open = std::any_of(
        refined.estimates.begin(), refined.estimates.end(), [&](const ParameterEstimate& one) {
          return !one.observable && one.name == space.effects().name(e);
        });
    const std::string& effect = space.effects().at(e).name;
    if (is_open && std::find(effects.begin(), effects.end(), effect) == effects.end()) {
      effects.push_back(effect);
    }
  }
  return effects;
}

ModelFit fitWith(const std::string& name,
                 const CalibratedDescription& start,
                 const std::vector<Sample>& samples,
                 CalibrationConfig config,
                 const EffectSelection& effects) {
  const bool is_predicted = concernsOrientations(config.effects, start.actuator);
  config.effects = effects;
  // A map would take up what an effect explains.
  config.orientation_map = MapUse::kNever;
  // A model that lacks an effect must neither be refused for its misfit, nor be spared the samples
  // that show it.
  config.estimation.max_reduced_chi_square = 1e9;
  config.estimation.max_rejected_fraction = 0.0;
  config.estimation.false_alarm_probability = 1e-12;
  CalibrationSession session(start, samples, config);
  for (const CycleRequest& request :
       possibleCycles(session.model(), session.samples(), config.estimation)) {
    session.run(withoutExpectedErrors(request));
  }
  const CycleReport refined = session.run(withoutExpectedErrors({Cycle::kRefine}));
  ModelFit fit;
  fit.effects = name;
  fit.converged = refined.success;
  fit.not_told = notTold(session.model().space(), refined);
  fit.parameters = static_cast<std::size_t>(std::count_if(
      refined.estimates.begin(), refined.estimates.end(), [](const ParameterEstimate& estimate) {
        return estimate.observable;
      }));
  sumUp(session, fit);
  const auto values = static_cast<double>(fit.values);
  const auto parameters = static_cast<double>(fit.parameters);
  fit.reduced_chi_square = values > parameters ? fit.chi_square / (values - parameters) : 0.0;
  fit.bic = fit.chi_square + parameters * std::log(std::max(values, 1.0));
  if (is_predicted && refined.success) {
    fit.held_out = heldOutError(session);
  }
  return fit;
}

}  // namespace

std::vector<ModelFit> compareEffects(const CalibratedDescription& start,
                                     const std::vector<Sample>& samples,
                                     const CalibrationConfig& config) {
  if (!config.effects.any()) {
    return {};
  }
  std::vector<ModelFit> fits;
  fits.push_back(fitWith("none", start, samples, config, {}));
  fits.push_back(fitWith("all", start, samples, config, config.effects));
  const std::vector<std::string> modelled = modelledEffects(config.effects);
  for (const std::string& effect : modelled) {
    if (modelled.size() > 1) {
      EffectSelection fewer = config.effects;
      fewer[effect] = false;
      fits.push_back(fitWith("without " + effect, start, samples, config, fewer));
    }
  }
  return fits;
}

const ModelFit& bestOf(const std::vector<ModelFit>& fits) {
  const bool is_predicted = std::all_of(fits.begin(), fits.end(), [](const ModelFit& fit) {
    return !fit.converged || fit.held_out.has_value();
  });
  return *std::min_element(
      fits.begin(), fits.end(), [is_predicted](const ModelFit& a, const ModelFit& b) {
        if (a.converged != b.converged) {
          return a.converged;
        }
        return is_predicted && a.converged ? *a.held_out < *b.held_out : a.bic < b.bic;
      });
}

namespace {

std::string notToldInWords(const std::vector<std::string>& effects) {
  std::string names;
  for (const std::string& effect : effects) {
    names += (names.empty() ? "" : ", ") + effect;
  }
  return names.empty() ? "" : "  (the samples cannot tell " + names + ")";
}

}  // namespace

std::vector<std::string> describe(const std::vector<ModelFit>& fits) {
  constexpr double kMilli = 1e3;
  std::vector<std::string> lines;
  for (const ModelFit& fit : fits) {
    const std::string predicted =
        fit.held_out ? format(", regions held out %.3f mrad", kMilli * *fit.held_out) : "";
    lines.push_back(
        format("effects: %-30s %4zu parameters, reduced chi-square %10.3f, BIC %12.1f%s%s%s",
               fit.effects.c_str(),
               fit.parameters,
               fit.reduced_chi_square,
               fit.bic,
               predicted.c_str(),
               &fit == &bestOf(fits) ? "  <- best" : "",
               fit.converged ? notToldInWords(fit.not_told).c_str() : "  (not converged)"));
  }
  return lines;
}

}  // namespace sac
