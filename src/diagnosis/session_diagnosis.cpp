#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "orientation_hypotheses.hpp"
#include "posterior_fit.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "torque_hypotheses.hpp"

namespace sac {
namespace {

/// A cause explains a misfit when it takes away so much of its excess at least.
constexpr double kExplainedShare = 0.8;
/// Misfits beyond it are none of chance: standard deviations of a reduced chi-square.
constexpr double kBeyondChance = 6.0;

/// A refinement from the start with some laboratory effects.
struct RefinedFit {
  bool converged = false;
  double reduced_chi_square = 0.0;
  double freedom = 0.0;  ///< observed values less estimated parameters
  std::vector<ParameterEstimate> estimates;

  /// Bayesian information criterion, the smaller the better.
  double bic() const {
    const auto parameters = static_cast<double>(estimates.size());
    return reduced_chi_square * freedom + parameters * std::log(freedom + parameters);
  }

  bool isBeyondChance() const {
    return freedom > 0.0 && reduced_chi_square > 1.0 + kBeyondChance * std::sqrt(2.0 / freedom);
  }
};

/// Cycles of a trial of the session: those that its data allow, and motion where it was recorded.
std::vector<CycleRequest> cyclesOf(const CalibrationSession& session, CalibrationSession& trial) {
  if (session.motion() == nullptr) {
    return possibleCycles(trial.model(), trial.samples(), trial.config().estimation);
  }
  // The session outlives its trial, and so does its recording.
  trial.setMotion(
      std::shared_ptr<const MotionRecording>(std::shared_ptr<void>(), session.motion()));
  return {{Cycle::kMotion}};
}

RefinedFit refined(const CalibrationSession& session, const EffectSelection& effects) {
  CalibrationConfig config = session.config();
  config.effects = effects;
  // A model that lacks an effect must neither be refused for its misfit, nor be spared the samples
  // that show it: only what is twenty standard deviations off is an outlier here.
  config.estimation.max_reduced_chi_square = 1e9;
  config.estimation.max_rejected_fraction = 0.49;
  config.estimation.false_alarm_probability = 1e-200;
  CalibrationSession trial(session.start(), session.samples(), config);
  RefinedFit fit;
  for (const CycleRequest& request : cyclesOf(session, trial)) {
    const CycleReport& report = trial.run(request);
    fit.converged = report.success;
    fit.reduced_chi_square = report.reduced_chi_square;
    fit.freedom = request.cycle == Cycle::kMotion
                      ? report.degrees_of_freedom
                      : 3.0 * static_cast<double>(report.residuals.size()) -
                            static_cast<double>(report.estimates.size());
    fit.estimates = report.estimates;
  }
  return fit;
}

/// Whether less misfit is left than what does not count as an explanation.
bool explains(double with_it, double without_it) {
  return with_it - 1.0 <= (1.0 - kExplainedShare) * (without_it - 1.0);
}

std::string valueInWords(const ParameterEstimate& estimate) {
  if (estimate.unit == "1") {
    constexpr double kFewest = 2.0;
    constexpr double kMost = 6.0;
    const double to_first_digit = std::ceil(-std::log10(1e2 * estimate.stddev));
    const auto decimals = static_cast<int>(std::min(std::max(to_first_digit, kFewest), kMost));
    return format("%s = %.*f %% ± %.*f %%",
                  estimate.name.c_str(),
                  decimals,
                  1e2 * estimate.value,
                  decimals,
                  1e2 * estimate.stddev);
  }
  return format("%s = %.3g ± %.2g %s",
                estimate.name.c_str(),
                estimate.value,
                estimate.stddev,
                estimate.unit.c_str());
}

/// The values of one effect that are known best in their own uncertainty, three at most.
std::string valuesInWords(const std::string& effect,
                          const ParameterSpace& space,
                          const std::vector<ParameterEstimate>& estimates) {
  std::vector<ParameterEstimate> own;
  for (const ParameterEstimate& estimate : estimates) {
    for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
      if (space.name(p) == estimate.name && space.effects().at(p - space.effect()).name == effect) {
        own.push_back(estimate);
      }
    }
  }
  std::stable_sort(
      own.begin(), own.end(), [](const ParameterEstimate& a, const ParameterEstimate& b) {
        return std::abs(a.value) * b.stddev > std::abs(b.value) * a.stddev;
      });
  constexpr std::size_t kMostShown = 3;
  std::string text;
  for (std::size_t n = 0; n < std::min(own.size(), kMostShown); ++n) {
    text += (n == 0 ? "" : ", ") + valueInWords(own[n]);
  }
  return own.size() > kMostShown ? text + ", …" : text;
}

/// Single effects that explain a misfit of the refinement, or of the motion, the best first.
std::vector<Diagnosis> effectsThatExplain(const CalibrationSession& session,
                                          const RefinedFit& unchanged) {
  std::vector<std::pair<double, Diagnosis>> found;
  for (const std::string& effect : effectNames()) {
    if (session.config().effects.has(effect) || !canHaveEffect(session.start().actuator, effect) ||
        (session.motion() != nullptr && !isToldByMotion(effect))) {
      continue;
    }
    EffectSelection effects = session.config().effects;
    effects[effect] = true;
    const RefinedFit fit = refined(session, effects);
    if (!fit.converged || !explains(fit.reduced_chi_square, unchanged.reduced_chi_square)) {
      continue;
    }
    const ParameterSpace space(session.start().actuator, effects);
    Diagnosis diagnosis;
    diagnosis.cause = effect;
    diagnosis.message =
        valuesInWords(effect, space, fit.estimates) +
        format(
            " explains it: chi-square %.3g → %.3g. Model it: effects: {%s: true} in "
            "calibration.yaml.",
            unchanged.reduced_chi_square,
            fit.reduced_chi_square,
            effect.c_str());
    diagnosis.evidence = 0.5 * unchanged.freedom *
                         (unchanged.reduced_chi_square - fit.reduced_chi_square) /
                         std::max(1.0, fit.reduced_chi_square);
    found.emplace_back(fit.bic(), std::move(diagnosis));
  }
  std::stable_sort(
      found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  constexpr double kDecisive = 10.0;  // difference of two criteria
  std::vector<Diagnosis> diagnoses;
  for (auto& [bic, diagnosis] : found) {
    if (bic < found.front().first + kDecisive) {
      diagnoses.push_back(std::move(diagnosis));
    }
  }
  return diagnoses;
}

/// Small turns of the torque's frame and small scales of joints that explain a misfit.
std::vector<Diagnosis> smallMistakes(const CalibrationSession& session) {
  const WiringCase described{session.start().actuator, session.samples()};
  const CalibrationConfig& config = session.config();
  const ModelAllowance none{0.0, 0.0};
  std::vector<Hypothesis> hypotheses;
  if (described.actuator.hasTorqueModel()) {
    hypotheses.push_back(torqueRotation(Eigen::Vector3d::Zero(), config.tolerance.pole));
  }
  for (const Hypothesis& hypothesis : jointHypotheses(described.actuator, config.tolerance)) {
    if (hypothesis.cause.rfind("joint_scale", 0) == 0) {
      hypotheses.push_back(hypothesis);
    }
  }
  const PosteriorFit base = fitPosterior(described, {}, FittedStream::kBoth, config, none);
  std::vector<Diagnosis> diagnoses;
  for (const Hypothesis& hypothesis : hypotheses) {
    const PosteriorFit fit =
        fitPosterior(described, {hypothesis}, FittedStream::kBoth, config, none);
    const double gain = fit.log_posterior - base.log_posterior;
    if (gain > gainByChance(fit.values.size()) &&
        explains(fit.scale * fit.scale, base.scale * base.scale)) {
      std::string message = hypothesis.sentence(fit.values);
      message.front() = static_cast<char>(std::toupper(message.front()));
      diagnoses.push_back({hypothesis.cause, message, gain});
    }
  }
  return diagnoses;
}

}  // namespace

std::vector<Diagnosis> diagnoseMistakes(const CalibrationSession& session) {
  return diagnoseWiring(session.start().actuator, session.samples(), session.config()).mistakes;
}

std::vector<Diagnosis> diagnose(const CalibrationSession& session) {
  std::vector<Diagnosis> diagnoses = diagnoseMistakes(session);
  if (!diagnoses.empty()) {
    return diagnoses;
  }
  const RefinedFit unchanged = refined(session, session.config().effects);
  if (!unchanged.isBeyondChance()) {
    return diagnoses;
  }
  diagnoses = effectsThatExplain(session, unchanged);
  if (session.motion() != nullptr) {
    return diagnoses;
  }
  for (Diagnosis& small : smallMistakes(session)) {
    diagnoses.push_back(std::move(small));
  }
  return diagnoses;
}

std::string inWords(const std::vector<Diagnosis>& diagnoses) {
  std::string text;
  for (const Diagnosis& diagnosis : diagnoses) {
    text += (text.empty() ? "" : " ") + diagnosis.message;
  }
  return text;
}

}  // namespace sac
