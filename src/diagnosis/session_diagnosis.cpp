#include "spherical_actuator_calibration/diagnosis/session_diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "evidence.hpp"
#include "explanation_words.hpp"
#include "motion_order.hpp"
#include "motion_poses.hpp"
#include "motion_wiring.hpp"
#include "single_explanations.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "torque_hypotheses.hpp"

namespace sac {
namespace {

/// Misfits beyond it are none of chance: standard deviations of a reduced chi-square.
constexpr double kBeyondChance = 6.0;

/// So many samples that are far off may have a cause in common.
constexpr std::uint32_t kManyRejected = 2;

/// Iterations of a motion: what explains is found soon; what does not goes on for minutes.
constexpr int kSoonFound = 12;

/// Of the misfit, by a sign of all currents: by the inertia it is all or nothing.
constexpr double kTurnedLeft = 0.5;

/// A refinement from the start with some laboratory effects.
struct RefinedFit {
  bool converged = false;
  double reduced_chi_square = 0.0;
  double freedom = 0.0;  ///< observed values less estimated parameters
  std::uint32_t rejected = 0;
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

/// The start with the orientation map in force: no trial searches its own.
CalibratedDescription mappedStart(const CalibrationSession& session) {
  CalibratedDescription start = session.start();
  start.actuator.orientation_map = session.model().space().nominal().orientation_map;
  return start;
}

RefinedFit refined(const CalibrationSession& session,
                   const EffectSelection& effects,
                   int max_iterations) {
  CalibrationConfig config = session.config();
  config.estimation.max_iterations = max_iterations;
  config.effects = effects;
  // A model that lacks an effect must neither be refused for its misfit, nor be spared the samples
  // that show it: only what is twenty standard deviations off is an outlier here.
  config.estimation.max_reduced_chi_square = 1e9;
  config.estimation.max_rejected_fraction = 0.49;
  config.estimation.false_alarm_probability = 1e-200;
  config.orientation_map = MapUse::kNever;
  CalibrationSession trial(mappedStart(session), session.samples(), config);
  RefinedFit fit;
  for (const CycleRequest& request : cyclesOf(session, trial)) {
    const CycleReport& report = trial.run(withoutExpectedErrors(request));
    // A motion that leaves axes open fits all the same: no mistake has to explain it.
    const bool fits_openly = request.cycle == Cycle::kMotion && report.degrees_of_freedom > 0;
    fit.converged = report.success || fits_openly;
    fit.reduced_chi_square = report.reduced_chi_square;
    fit.freedom = request.cycle == Cycle::kMotion
                      ? report.degrees_of_freedom
                      : 3.0 * static_cast<double>(report.residuals.size()) -
                            static_cast<double>(report.estimates.size());
    fit.rejected = report.samples_rejected;
    fit.estimates = report.estimates;
  }
  return fit;
}

/// Whether less misfit is left than what does not count as an explanation, and than a cycle bears.
bool explains(double with_it, double without_it, double most) {
  return with_it <= most && with_it - 1.0 <= (1.0 - kExplainedShare) * (without_it - 1.0);
}

/// Its own values, and nothing where no observation tells them.
std::vector<ParameterEstimate> valuesOf(const std::string& effect,
                                        const ParameterSpace& space,
                                        const std::vector<ParameterEstimate>& estimates) {
  std::vector<ParameterEstimate> own;
  for (const ParameterEstimate& estimate : estimates) {
    for (Eigen::Index p = space.effect(); p < space.size(); ++p) {
      if (space.name(p) == estimate.name && space.effects().at(p - space.effect()).name == effect &&
          estimate.observable) {
        own.push_back(estimate);
      }
    }
  }
  return own;
}

/// Mistakes of wiring without which the cycle of the motion succeeds; otherwise none.
std::vector<Diagnosis> confirmed(const CalibrationSession& session,
                                 const SuspectedWiring& suspected) {
  CorrectedMotion motion =
      correctedMotion(session.start().actuator, *session.motion(), suspected.parts);
  CalibrationConfig config = session.config();
  config.estimation.max_iterations = kSoonFound;
  CalibrationSession trial({motion.actuator}, {}, config);
  trial.setMotion(std::make_shared<const MotionRecording>(std::move(motion.recording)));
  const CycleReport& report = trial.run(withoutExpectedErrors({Cycle::kMotion}));
  if (!report.success) {
    return {};
  }
  std::vector<Diagnosis> diagnoses;
  for (const Hypothesis& hypothesis : suspected.parts) {
    Diagnosis diagnosis;
    diagnosis.cause = hypothesis.cause;
    diagnosis.message = hypothesis.sentence(hypothesis.start);
    if (hypothesis.cause == "current_unit") {
      diagnosis.message +=
          " A motion tells only the ratio of currents and inertia: a rotor that is as much "
          "lighter or heavier looks the same.";
    }
    // By what one step leaves: with the mistake a fit may find no end.
    diagnosis.evidence =
        0.5 * report.degrees_of_freedom * (1.0 - suspected.share_left) / suspected.share_left;
    diagnoses.push_back(std::move(diagnosis));
  }
  return diagnoses;
}

/// A mistake of wiring that explains a misfit of the motion. The order of the coils is soon found,
/// however many are beside their places; what else there is, alone or beside them, takes a step for
/// each.
std::vector<Diagnosis> wiringThatExplainsMotion(const CalibrationSession& session) {
  const std::optional<MotionOrder> found = orderOfMotion(session);
  const std::optional<SuspectedWiring> order = found ? found->mistakes : std::nullopt;
  std::vector<Diagnosis> diagnoses;
  if (order) {
    diagnoses = confirmed(session, *order);
  }
  if (diagnoses.empty()) {
    SuspectedWiring turned = order.value_or(SuspectedWiring{{}, kTurnedLeft});
    turned.parts.push_back(currentSign());
    diagnoses = confirmed(session, turned);
  }
  std::vector<Candidate> known;
  if (order) {
    known.push_back(order->parts);
  }
  known.emplace_back();
  const DelayRange delays =
      found && found->current_delay ? DelayRange().about(*found->current_delay) : DelayRange();
  for (const Candidate& mistakes : known) {
    if (!diagnoses.empty()) {
      break;
    }
    for (const SuspectedWiring& suspected : suspectedWiring(session, mistakes, delays)) {
      diagnoses = confirmed(session, suspected);
      if (!diagnoses.empty()) {
        break;
      }
    }
  }
  return diagnoses;
}

/// The mistakes of wiring that diagnoses of a motion name; of others none.
Candidate namedMistakes(const CalibrationSession& session,
                        const std::vector<Diagnosis>& diagnoses) {
  Candidate all = motionMistakes(session.start().actuator);
  const bool may_be_an_order =
      std::any_of(diagnoses.begin(), diagnoses.end(), [](const Diagnosis& one) {
        return one.cause == "coil_shift" || one.cause.rfind("coil_circle", 0) == 0;
      });
  if (may_be_an_order) {
    const std::optional<MotionOrder> order = orderOfMotion(session);
    if (order && order->mistakes) {
      all.insert(all.end(), order->mistakes->parts.begin(), order->mistakes->parts.end());
    }
  }
  Candidate named;
  for (const Diagnosis& diagnosis : diagnoses) {
    // Shifts have one cause, and differ in what they say.
    const auto mistake = std::find_if(all.begin(), all.end(), [&](const Hypothesis& one) {
      return one.cause == diagnosis.cause &&
             diagnosis.message.rfind(one.sentence(one.start), 0) == 0;
    });
    if (mistake != all.end()) {
      named.push_back(*mistake);
    }
  }
  return named;
}

/// Single effects that explain a misfit of the motion, the best first.
std::vector<Diagnosis> effectsThatExplainMotion(const CalibrationSession& session,
                                                const RefinedFit& unchanged) {
  const double most = session.config().estimation.max_reduced_chi_square;
  std::vector<std::pair<double, Diagnosis>> found;
  for (const std::string& effect : effectNames()) {
    if (session.config().effects.has(effect) || !canHaveEffect(session.start().actuator, effect) ||
        !isToldByMotion(effect)) {
      continue;
    }
    EffectSelection effects = session.config().effects;
    effects[effect] = true;
    const RefinedFit fit = refined(session, effects, kSoonFound);
    const ParameterSpace space(session.start().actuator, effects);
    const std::vector<ParameterEstimate> values = valuesOf(effect, space, fit.estimates);
    if (!fit.converged || !explains(fit.reduced_chi_square, unchanged.reduced_chi_square, most) ||
        std::none_of(values.begin(), values.end(), isSignificant)) {
      continue;
    }
    Diagnosis diagnosis;
    diagnosis.cause = effect;
    diagnosis.message = valuesInWords(values) +
                        explainsInWords(unchanged.reduced_chi_square, fit.reduced_chi_square) +
                        " Model it: effects: {" + effect + ": true} in calibration.yaml.";
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

/// Wiring first: from where a mistake of it leads, descents go on for ever.
std::vector<Diagnosis> explainMotion(const CalibrationSession& session) {
  const EffectSelection& effects = session.config().effects;
  RefinedFit unchanged = refined(session, effects, kSoonFound);
  if (unchanged.converged && !unchanged.isBeyondChance()) {
    return {};
  }
  // Joints and tracker need no torque to be seen through.
  std::vector<Diagnosis> diagnoses =
      diagnosePosesOfMotion(session.start().actuator, *session.motion(), session.config()).mistakes;
  if (!diagnoses.empty()) {
    return diagnoses;
  }
  diagnoses = wiringThatExplainsMotion(session);
  if (!diagnoses.empty()) {
    return diagnoses;
  }
  if (!unchanged.converged) {
    unchanged = refined(session, effects, session.config().estimation.max_iterations);
  }
  return unchanged.isBeyondChance() ? effectsThatExplainMotion(session, unchanged) : diagnoses;
}

}  // namespace

std::optional<Redescription> redescribedMotion(const CalibrationSession& session,
                                               const std::vector<Diagnosis>& diagnoses) {
  if (session.motion() == nullptr || diagnoses.empty()) {
    return std::nullopt;
  }
  const Actuator& nominal = session.start().actuator;
  WiringDiagnosis poses = diagnosePosesOfMotion(nominal, *session.motion(), session.config());
  if (!poses.mistakes.empty() && poses.mistakes.front().cause == diagnoses.front().cause) {
    return Redescription{std::move(poses.redescribed), std::move(poses.beyond_description)};
  }
  const Candidate mistakes = namedMistakes(session, diagnoses);
  if (mistakes.empty()) {
    return std::nullopt;
  }
  Redescription result{nominal, {}};
  // Currents are corrected by one after the other; what they belong to, by the last one first.
  for (auto mistake = mistakes.rbegin(); mistake != mistakes.rend(); ++mistake) {
    if (mistake->redescribe) {
      mistake->redescribe(result.actuator, mistake->start);
    } else {
      result.beyond_description.push_back(mistake->cause);
    }
  }
  return result;
}

std::vector<Diagnosis> diagnoseMistakes(const CalibrationSession& session) {
  return diagnoseWiring(session.start().actuator, session.samples(), session.config()).mistakes;
}

std::vector<Diagnosis> diagnose(const CalibrationSession& session) {
  std::vector<Diagnosis> diagnoses = diagnoseMistakes(session);
  if (!diagnoses.empty()) {
    return diagnoses;
  }
  if (session.motion() != nullptr) {
    return explainMotion(session);
  }
  const RefinedFit unchanged =
      refined(session, session.config().effects, session.config().estimation.max_iterations);
  if (unchanged.converged && !unchanged.isBeyondChance() && unchanged.rejected < kManyRejected) {
    return diagnoses;
  }
  return singleExplanations({mappedStart(session).actuator, session.samples()}, session.config());
}

std::string inWords(const std::vector<Diagnosis>& diagnoses) {
  std::string text;
  for (const Diagnosis& diagnosis : diagnoses) {
    text += (text.empty() ? "" : " ") + diagnosis.message;
  }
  return text;
}

std::string verdictInWords(const CalibrationSession& session,
                           const std::vector<Diagnosis>& diagnoses) {
  if (!diagnoses.empty()) {
    return inWords(diagnoses);
  }
  const std::string why = session.motion() != nullptr
                              ? std::string()
                              : whyNothingIsTold(session.start().actuator, session.samples());
  return why.empty() ? "Nothing speaks for a mistake." : why;
}

}  // namespace sac
