#include "motion_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>

#include "ambiguous_motion.hpp"
#include "cycle_checks.hpp"
#include "cycle_conclusion.hpp"
#include "motion_doubts.hpp"
#include "motion_dynamics.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/effect_name.hpp"
#include "spherical_actuator_calibration/motion/better_currents.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"
#include "spherical_actuator_calibration/motion/silent_coils.hpp"
#include "uneven_strengths.hpp"
#include "wider_space.hpp"

namespace sac {
namespace {

constexpr char kBegin[] = "Motion: ";

std::string refusal(const CalibrationModel& model, const MotionRecording* recording) {
  if (!model.hasTorqueModel()) {
    return "The actuator description has no poles, coils or torque curve: motion tells nothing "
           "without them.";
  }
  if (model.space().joints() == 0) {
    return "The description has no joints: motion is followed by their readings, which there are "
           "none of. Calibrate from rests.";
  }
  if (recording == nullptr || recording->empty()) {
    return "No motion is recorded: the rotor has to move while joint_states and coil_currents "
           "come.";
  }
  return {};
}

/// Whether inertia, friction and delays are among the parameters.
bool knowsMotion(const ParameterSpace& space) {
  for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
    if (space.effects().at(e).acts_on == LaboratoryEffect::ActsOn::kMotion) {
      return true;
    }
  }
  return false;
}

/// The state where some coordinates are, and the one of `others` elsewhere.
CalibrationState widened(const CalibrationState& state,
                         const std::vector<Eigen::Index>& places,
                         CalibrationState others) {
  others.belief = widened(state.belief, places, others.belief);
  for (std::size_t n = 0; n < places.size(); ++n) {
    others.identified[static_cast<std::size_t>(places[n])] = state.identified[n];
  }
  return others;
}

CalibrationState narrowed(const CalibrationState& state, const std::vector<Eigen::Index>& places) {
  CalibrationState result;
  result.belief.x = state.belief.x(places);
  result.belief.covariance = state.belief.covariance(places, places);
  for (const Eigen::Index place : places) {
    result.identified.push_back(state.identified[static_cast<std::size_t>(place)]);
  }
  return result;
}

/// Whether a recording of motion feels an effect at all.
bool actsOnMotion(const PlacedEffect& placed, bool has_orientations) {
  switch (placed.belongs_to) {
    case LaboratoryEffect::BelongsTo::kTorqueSensor:
      return false;
    case LaboratoryEffect::BelongsTo::kTracker:
      return has_orientations;
    case LaboratoryEffect::BelongsTo::kActuator:
    case LaboratoryEffect::BelongsTo::kLoad:
      break;
  }
  return true;
}

/// Whether an effect changes the strength of coils, poles or curve: motion tells only its ratio to
/// inertia.
bool changesStrength(const PlacedEffect& placed, const ParameterSpace& space) {
  return placed.effect->changesCurve() ||
         placed.effect->strengthCoordinate(space.poles() - 1, space.coils() - 1) >= 0;
}

/// Whether any strength is among the parameters.
bool hasStrengths(const ParameterSpace& space) {
  const std::vector<PlacedEffect>& effects = space.effects().effects();
  return std::any_of(effects.begin(), effects.end(), [&](const PlacedEffect& placed) {
    return changesStrength(placed, space);
  });
}

/// Whether a coordinate is a principal moment of inertia, or a relative change of strength: what it
/// is when it is 0 itself. Nothing: neither.
std::optional<double> strengthOrInertia(const ParameterSpace& space, Eigen::Index effect) {
  const PlacedEffect& placed = space.effects().at(effect);
  if (placed.name == effect_name::kRotorInertia) {
    return effect - placed.first < 3 ? std::optional<double>(0.0) : std::nullopt;
  }
  const bool is_strength =
      placed.effect->strengthCoordinate(space.poles() - 1, space.coils() - 1) >= 0;
  return is_strength ? std::optional<double>(1.0) : std::nullopt;
}

/// Momentum tells the ratio of strength and inertia, also where one of them would be negative.
std::string wrongSign(const ParameterSpace& space,
                      const Estimate& estimate,
                      const std::vector<Eigen::Index>& free) {
  constexpr double kSure = 5.0;  // standard deviations
  const ParameterBelief& belief = estimate.belief;
  const Eigen::VectorXd values = space.reportedValues(belief.x);
  const Eigen::VectorXd stddevs = space.reportedStddevs(belief.x, belief.covariance);
  for (const Eigen::Index p : free) {
    if (p < space.effect()) {
      continue;
    }
    const std::optional<double> base = strengthOrInertia(space, p - space.effect());
    if (base && *base + values[p] + kSure * stddevs[p] < 0.0) {
      return format(
          "%s would be %.3g, a %s below zero; check the signs of currents and polarities.",
          space.name(p).c_str(),
          values[p],
          *base == 0.0 ? "moment of inertia" : "strength");
    }
  }
  return {};
}

/// The reasons of most windows, and how many windows have others.
std::vector<WindowsLeftOut> usualReasons(const MotionSummary& summary) {
  constexpr std::size_t kMostNamed = 4;
  std::vector<WindowsLeftOut> reasons = summary.left_out;
  std::stable_sort(
      reasons.begin(), reasons.end(), [](const WindowsLeftOut& one, const WindowsLeftOut& other) {
        return one.count > other.count;
      });
  if (reasons.size() > kMostNamed) {
    WindowsLeftOut others{"other reasons, which the report lists", 0};
    for (std::size_t n = kMostNamed - 1; n < reasons.size(); ++n) {
      others.count += reasons[n].count;
    }
    reasons.resize(kMostNamed - 1);
    reasons.push_back(others);
  }
  return reasons;
}

/// " of 79 (3: the rotor rests)"; empty where none is left out.
std::string leftOutInWords(const MotionSummary& summary) {
  std::string words;
  for (const WindowsLeftOut& one : usualReasons(summary)) {
    words += format("%s%zu: %s", words.empty() ? "" : "; ", one.count, one.reason.c_str());
  }
  return words.empty() ? words : format(" of %zu (%s)", summary.windows, words.c_str());
}

std::string tooFewInWords(const MotionSummary& summary) {
  std::size_t left_out = 0;
  for (const WindowsLeftOut& one : summary.left_out) {
    left_out += one.count;
  }
  return format("%zu windows%s are too few; record a longer motion with currents in all coils.",
                summary.windows - left_out,
                leftOutInWords(summary).c_str());
}

/// "", or a sentence with a space behind it.
std::string endsInWords(const std::vector<WindowsLeftOut>& at_end) {
  const auto most = std::max_element(
      at_end.begin(), at_end.end(), [](const WindowsLeftOut& one, const WindowsLeftOut& other) {
        return one.count < other.count;
      });
  return most == at_end.end() ? std::string()
                              : format("In %zu windows %s%s. ",
                                       most->count,
                                       most->reason.c_str(),
                                       at_end.size() > 1 ? ", and others are, too" : "");
}

/// Why an estimate is not to be used; empty: it is.
std::string failure(const MotionProblem& problem,
                    const MotionEstimate& found,
                    const EstimationOptions& options) {
  const Estimate& estimate = found.estimate;
  switch (estimate.termination) {
    case Termination::kTooFewObservations:
      return tooFewInWords(found.summary);
    case Termination::kNothingObservable:
      return "the recording tells nothing about the parameters; record a motion of all joints with "
             "currents in all coils.";
    case Termination::kIterationLimit:
    case Termination::kNumericalFailure:
      return "no convergence; check signs and clocks of the streams, and the nominal description.";
    case Termination::kConverged:
      break;
  }
  const MotionSummary& summary = found.summary;
  const auto rejected = static_cast<double>(summary.windows - summary.used);
  if (rejected > options.max_rejected_fraction * static_cast<double>(summary.windows) &&
      summary.used * summary.values < 2 * static_cast<std::size_t>(estimate.belief.x.size())) {
    return format(
        "%.0f windows%s cannot serve; record again, with all streams and without touching the "
        "rotor.",
        rejected,
        leftOutInWords(summary).c_str());
  }
  const double worst = std::max(summary.window_chi_square, summary.orientation_chi_square);
  if (worst > options.max_reduced_chi_square) {
    const std::string skew = skewInWords(found);
    const bool is_balance = summary.window_chi_square >= summary.orientation_chi_square;
    return format("residuals of %s are %.1f times their noise; the motion does not fit the model. ",
                  is_balance ? "the momentum balance" : "the tracker",
                  std::sqrt(worst)) +
           (skew.empty() ? skew : skew + " ") +
           (is_balance
                ? endsInWords(found.at_end) +
                      "Check signs, channels, zeros and filters of currents, torque curve, "
                      "strengths, polarities, joint sensors and the clocks of the streams. Where a "
                      "force/torque sensor "
                      "is at hand, samples at rest tell more (diagnose)."
                : "Check joint sensors, frames, and the tracker with its clock and filters.");
  }
  const std::string sign = wrongSign(problem.model->space(), estimate, problem.free);
  return sign.empty() ? deviation(problem.model->space(), estimate, problem.free, options) : sign;
}

void fillReport(const MotionEstimate& found, CycleReport& report) {
  const Estimate& estimate = found.estimate;
  report.motion = found.summary;
  report.samples_used = static_cast<std::uint32_t>(found.summary.used);
  report.samples_rejected = 0;
  reportIteration(estimate, report);
  report.error_measure = ErrorMeasure::kStandardized;
  for (const ObservationResidual& from : estimate.residuals) {
    const auto id = static_cast<std::uint32_t>(from.observation.sample + 1);
    report.residuals.push_back(reportedResidual(from, id));
    report.samples_rejected += from.rejected ? 1U : 0U;
  }
}

/// "", or a sentence.
std::string silentInWords(const std::vector<std::size_t>& coils) {
  if (coils.empty()) {
    return {};
  }
  std::string numbers;
  for (const std::size_t coil : coils) {
    numbers += (numbers.empty() ? "" : ", ") + std::to_string(numberOf(coil));
  }
  return " No current beyond the noise of its reading flowed in coil " + numbers +
         ": what it would tell stays at the prior. Check amplifier and wiring.";
}

std::string successInWords(const MotionSummary& summary, std::size_t unobservable) {
  std::string words =
      format("Motion of %.0f s calibrated from %zu windows of momentum and %zu orientations.",
             summary.duration,
             summary.used,
             summary.orientations);
  for (const WindowsLeftOut& left_out : usualReasons(summary)) {
    words += format(" %zu windows left out: %s.", left_out.count, left_out.reason.c_str());
  }
  if (summary.held_out.windows > 0) {
    words += format(" %zu of the windows judged it before they served.", summary.held_out.windows);
  }
  if (unobservable > 0) {
    words += format(" %zu parameters are not told by this motion: they stay at the prior.",
                    unobservable);
  }
  return words;
}

HasOrientations orientationsIn(const MotionRecording& recording) {
  const bool has_any =
      std::any_of(recording.spans.begin(), recording.spans.end(), [](const MotionStreams& streams) {
        return !streams.orientations.empty();
      });
  return has_any ? HasOrientations::kYes : HasOrientations::kNo;
}

/// With a model that knows motion.
CycleOutcome runWithMotion(const CalibrationModel& model,
                           const MotionRecording& recording,
                           const CalibrationState& state,
                           const CalibrationConfig& config) {
  CycleOutcome outcome{{}, state};
  CycleReport& report = outcome.report;
  report.cycle = Cycle::kMotion;
  MotionProblem problem;
  problem.model = &model;
  problem.recording = &recording;
  problem.prior = state.belief;
  const std::vector<Eigen::Index> asked =
      motionCoordinates(model.space(), orientationsIn(recording));
  const std::vector<std::size_t> silent = silentCoils(recording);
  const std::vector<Eigen::Index> untold = coordinatesOfCoils(model.space(), silent);
  std::set_difference(
      asked.begin(), asked.end(), untold.begin(), untold.end(), std::back_inserter(problem.free));
  const std::optional<MotionRecording> commanded = byCommands(recording);
  const MotionEstimate found = estimateByBetterCurrents(commanded, config.estimation, problem);
  const std::string words = failure(problem, found, config.estimation);
  report.motion = found.summary;
  if (!words.empty()) {
    report.contradicted = found.estimate.termination == Termination::kConverged;
    report.message = kBegin + words;
    return outcome;
  }
  fillReport(found, report);
  const std::string ambiguous = ambiguityInWords(problem, found.estimate);
  if (!ambiguous.empty()) {
    report.message = kBegin + ambiguous;
    return outcome;
  }
  report.doubts = motionDoubts(found, recording);
  if (!hasStrengths(model.space())) {
    const UnevenStrengths uneven =
        unevenStrengths(problem, found.estimate.belief.x, silent, config);
    // First where it names what to mend: that windows contradict each other may follow from it.
    report.doubts.insert(uneven.stands_out ? report.doubts.begin() : report.doubts.end(),
                         uneven.words.empty() ? 0 : 1,
                         uneven.words);
  }
  CycleCoordinates coordinates;
  coordinates.requested = asked;
  std::set_union(found.estimate.unobservable.begin(),
                 found.estimate.unobservable.end(),
                 untold.begin(),
                 untold.end(),
                 std::back_inserter(coordinates.unobservable));
  conclude(model, found.estimate, coordinates, ExpectedErrors::kReported, outcome.state, report);
  report.message = successInWords(found.summary, coordinates.unobservable.size()) +
                   silentInWords(silent) + exactInertiaInWords(model.space()) +
                   strangeInertiaInWords(report, model.space().nominal());
  for (const std::string& doubt : report.doubts) {
    report.message += " " + doubt;
  }
  return outcome;
}

}  // namespace

std::vector<Eigen::Index> motionCoordinates(const ParameterSpace& space,
                                            HasOrientations has_orientations) {
  std::vector<Eigen::Index> coordinates(static_cast<std::size_t>(space.effect()));
  std::iota(coordinates.begin(), coordinates.end(), 0);
  const bool strength_moves = hasStrengths(space);
  for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
    // Beside strengths one inertia is the reference; else all could shrink to nothing.
    const bool is_reference = strength_moves && space.effects().name(e) == "rotor_inertia/zz";
    if (!is_reference &&
        actsOnMotion(space.effects().at(e), has_orientations == HasOrientations::kYes)) {
      coordinates.push_back(space.effect() + e);
    }
  }
  return coordinates;
}

CycleOutcome runMotionCycle(const CalibrationModel& model,
                            const MotionRecording* recording,
                            const CalibrationState& state,
                            const CalibrationConfig& config) {
  CycleOutcome refused{{}, state};
  refused.report.cycle = Cycle::kMotion;
  refused.report.message = refusal(model, recording);
  if (!refused.report.message.empty()) {
    return refused;
  }
  if (knowsMotion(model.space())) {
    return runWithMotion(model, *recording, state, config);
  }
  const CalibrationModel wide(
      ParameterSpace(model.space().nominal(), withMotionEffects(config.effects)));
  const std::vector<Eigen::Index> places = placesIn(wide.space(), model.space());
  const CalibrationState start =
      widened(state, places, nominalState(wide.space(), config.tolerance));
  CycleOutcome outcome = runWithMotion(wide, *recording, start, config);
  outcome.state = narrowed(outcome.state, places);
  return outcome;
}

}  // namespace sac
