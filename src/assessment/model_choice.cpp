#include "spherical_actuator_calibration/assessment/model_choice.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"

namespace sac {
namespace {

/// Σ rᵀN⁻¹r over all observations of the refinement, and their number of values.
void sumUp(const CalibrationSession& session, ModelFit& fit) {
  const EstimationOptions& options = session.config().estimation;
  EstimationProblem problem;
  problem.model = &session.model();
  problem.samples = &session.samples();
  problem.observations = selectObservations(session.samples(), {Cycle::kRefine}, options);
  problem.prior = session.state().belief;
  const ObservationEvaluator evaluator(problem, options);
  LinearizedObservation linear;
  for (std::size_t n = 0; n < problem.observations.size(); ++n) {
    evaluator.linearize(n, problem.prior.x, linear);
    fit.chi_square += linear.residual.dot(evaluator.noise(n, linear).llt().solve(linear.residual));
    fit.values += 3;
  }
}

ModelFit fitWith(const std::string& name,
                 const CalibratedDescription& start,
                 const std::vector<Sample>& samples,
                 CalibrationConfig config,
                 const EffectSelection& effects) {
  config.effects = effects;
  // A model that lacks an effect must neither be refused for its misfit, nor be spared the samples
  // that show it.
  config.estimation.max_reduced_chi_square = 1e9;
  config.estimation.max_rejected_fraction = 0.0;
  config.estimation.false_alarm_probability = 1e-12;
  CalibrationSession session(start, samples, config);
  for (const CycleRequest& request :
       possibleCycles(session.model(), session.samples(), config.estimation)) {
    session.run(request);
  }
  const CycleReport refined = session.run({Cycle::kRefine});
  ModelFit fit;
  fit.effects = name;
  fit.converged = refined.success;
  fit.parameters = static_cast<std::size_t>(std::count_if(
      refined.estimates.begin(), refined.estimates.end(), [](const ParameterEstimate& estimate) {
        return estimate.observable;
      }));
  sumUp(session, fit);
  const auto values = static_cast<double>(fit.values);
  const auto parameters = static_cast<double>(fit.parameters);
  fit.reduced_chi_square = values > parameters ? fit.chi_square / (values - parameters) : 0.0;
  fit.bic = fit.chi_square + parameters * std::log(std::max(values, 1.0));
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

std::vector<std::string> describe(const std::vector<ModelFit>& fits) {
  const auto best = std::min_element(
      fits.begin(), fits.end(), [](const ModelFit& a, const ModelFit& b) { return a.bic < b.bic; });
  std::vector<std::string> lines;
  for (auto fit = fits.begin(); fit != fits.end(); ++fit) {
    lines.push_back(
        format("effects: %-30s %4zu parameters, reduced chi-square %10.3f, BIC %12.1f%s%s",
               fit->effects.c_str(),
               fit->parameters,
               fit->reduced_chi_square,
               fit->bic,
               fit == best ? "  <- best" : "",
               fit->converged ? "" : "  (not converged)"));
  }
  return lines;
}

}  // namespace sac
