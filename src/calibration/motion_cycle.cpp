#include "motion_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "cycle_conclusion.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"

namespace sac {
namespace {

constexpr char kBegin[] = "Motion: ";

std::string refusal(const CalibrationModel& model, const MotionRecording* recording) {
  if (!model.hasTorqueModel()) {
    return "The actuator description has no poles, coils or torque curve: motion tells nothing "
           "without them.";
  }
  if (recording == nullptr || recording->empty()) {
    return "No motion is recorded: joint_states and coil_currents are needed together.";
  }
  const Eigen::Index places = model.space().effects().size();
  for (Eigen::Index e = 0; e < places; ++e) {
    if (model.space().effects().at(e).acts_on == LaboratoryEffect::ActsOn::kMotion) {
      return {};
    }
  }
  return "The effects of motion are not modelled.";
}

/// Whether the data of a recording of motion can tell an effect at all.
bool isToldByMotion(const PlacedEffect& placed, bool has_orientations) {
  const bool is_of_sensor = placed.name == "torque_bias" || placed.name == "torque_registration";
  const bool is_of_tracker =
      placed.name == "tracker_delay" || placed.acts_on == LaboratoryEffect::ActsOn::kOrientations;
  return !is_of_sensor && (has_orientations || !is_of_tracker);
}

/// Whether an effect changes the strength of coils, poles or curve: motion tells only its ratio to
/// inertia.
bool changesStrength(const PlacedEffect& placed, const ParameterSpace& space) {
  return placed.effect->changesCurve() ||
         placed.effect->strengthCoordinate(0, space.coils() - 1) >= 0;
}

std::vector<Eigen::Index> requestedCoordinates(const ParameterSpace& space,
                                               const MotionRecording& recording) {
  const bool has_orientations =
      std::any_of(recording.spans.begin(), recording.spans.end(), [](const MotionStreams& streams) {
        return !streams.orientations.empty();
      });
  std::vector<Eigen::Index> coordinates(static_cast<std::size_t>(space.effect()));
  std::iota(coordinates.begin(), coordinates.end(), 0);
  const std::vector<PlacedEffect>& effects = space.effects().effects();
  const bool strength_moves =
      std::any_of(effects.begin(), effects.end(), [&](const PlacedEffect& placed) {
        return changesStrength(placed, space);
      });
  for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
    // Beside strengths one inertia is the reference; else all could shrink to nothing.
    const bool is_reference = strength_moves && space.effects().name(e) == "rotor_inertia/zz";
    if (!is_reference && isToldByMotion(space.effects().at(e), has_orientations)) {
      coordinates.push_back(space.effect() + e);
    }
  }
  return coordinates;
}

/// Axes that would lie too far from their drawing, in words; empty: none.
std::string deviation(const CalibrationModel& model,
                      const Estimate& estimate,
                      const EstimationOptions& options) {
  constexpr double kSure = 3.0;  // standard deviations
  const ParameterSpace& space = model.space();
  for (Eigen::Index p = 0; p < space.effect(); ++p) {
    const double limit = options.max_deviation * toleranceOf(space.id(p).kind, options.tolerance);
    const double stddev = std::sqrt(std::max(0.0, estimate.belief.covariance(p, p)));
    if (limit > 0.0 && std::abs(estimate.belief.x[p]) - kSure * stddev > limit) {
      return format(
          "%s would lie %.2g rad from its drawing, more than %.0f tolerances of manufacture; check "
          "the wiring of sensors and coils, all frames, and the nominal description.",
          space.name(p).c_str(),
          std::abs(estimate.belief.x[p]),
          options.max_deviation);
    }
  }
  return {};
}

/// Why an estimate is not to be used; empty: it is.
std::string failure(const CalibrationModel& model,
                    const MotionEstimate& found,
                    const EstimationOptions& options) {
  const Estimate& estimate = found.estimate;
  switch (estimate.termination) {
    case Termination::kTooFewObservations:
      return format(
          "%zu windows of motion are not enough; record a longer motion with currents in all "
          "coils.",
          found.summary.windows);
    case Termination::kNothingObservable:
      return "the recording tells nothing about the parameters.";
    case Termination::kIterationLimit:
    case Termination::kNumericalFailure:
      return "no convergence; check the streams and the nominal description.";
    case Termination::kConverged:
      break;
  }
  const MotionSummary& summary = found.summary;
  const auto rejected = static_cast<double>(summary.windows - summary.used);
  if (rejected > options.max_rejected_fraction * static_cast<double>(summary.windows) &&
      summary.used * summary.values < 2 * static_cast<std::size_t>(estimate.belief.x.size())) {
    return format("%.0f of %zu windows cannot serve.", rejected, summary.windows);
  }
  const double worst = std::max(summary.window_chi_square, summary.orientation_chi_square);
  if (worst > options.max_reduced_chi_square) {
    const bool is_balance = summary.window_chi_square >= summary.orientation_chi_square;
    return format("residuals of %s are %.1f times their noise; the motion does not fit the model. ",
                  is_balance ? "the momentum balance" : "the tracker",
                  std::sqrt(worst)) +
           (is_balance ? "Check torque curve, strengths, polarities, currents and joint sensors."
                       : "Check joint sensors, frames and the tracker.");
  }
  return deviation(model, estimate, options);
}

std::vector<std::string> doubts(const MotionEstimate& found) {
  constexpr double kLarge = 2.25;
  std::vector<std::string> words;
  if (found.estimate.covariance_scale > 1.0 && found.summary.window_chi_square > kLarge) {
    words.push_back(
        format("Residuals are %.1f times their noise: something is not modelled, and may bias the "
               "parameters.",
               std::sqrt(found.summary.window_chi_square)));
  }
  return words;
}

void fillReport(const MotionEstimate& found, CycleReport& report) {
  const Estimate& estimate = found.estimate;
  report.motion = found.summary;
  report.samples_used = static_cast<std::uint32_t>(found.summary.used);
  report.samples_rejected = 0;
  report.iterations = static_cast<std::uint32_t>(estimate.iterations);
  report.error_measure = ErrorMeasure::kStandardized;
  report.error_history = estimate.error_history;
  report.reduced_chi_square = estimate.reduced_chi_square;
  report.degrees_of_freedom = estimate.degrees_of_freedom;
  report.condition_number = estimate.condition_number;
  report.solve_time = estimate.solve_time;
  for (const ObservationResidual& from : estimate.residuals) {
    SampleResidual residual;
    residual.id = static_cast<std::uint32_t>(from.observation.sample + 1);
    residual.quantity = from.observation.quantity;
    residual.residual = from.residual.norm();
    residual.standardized = from.standardized;
    residual.rejected = from.rejected;
    if (from.rejected) {
      residual.reason = format("misfit is %.1f times its uncertainty", from.standardized);
      ++report.samples_rejected;
    }
    report.residuals.push_back(residual);
  }
}

std::string successInWords(const MotionSummary& summary, std::size_t unobservable) {
  std::string words =
      format("Motion of %.0f s calibrated from %zu windows of momentum and %zu orientations.",
             summary.duration,
             summary.used,
             summary.orientations);
  for (const WindowsLeftOut& left_out : summary.left_out) {
    words += format(" %zu windows left out: %s.", left_out.count, left_out.reason.c_str());
  }
  if (unobservable > 0) {
    words += format(" %zu parameters are not told by this motion: they stay at the prior.",
                    unobservable);
  }
  return words;
}

}  // namespace

CycleOutcome runMotionCycle(const CalibrationModel& model,
                            const MotionRecording* recording,
                            const CalibrationState& state,
                            const CalibrationConfig& config) {
  CycleOutcome outcome{{}, state};
  CycleReport& report = outcome.report;
  report.cycle = Cycle::kMotion;
  report.message = refusal(model, recording);
  if (!report.message.empty()) {
    return outcome;
  }
  MotionProblem problem;
  problem.model = &model;
  problem.recording = recording;
  problem.prior = state.belief;
  problem.free = requestedCoordinates(model.space(), *recording);
  const MotionEstimate found = estimateMotion(problem, config.estimation, MotionOptions());
  const std::string words = failure(model, found, config.estimation);
  report.motion = found.summary;
  if (!words.empty()) {
    report.contradicted = found.estimate.termination == Termination::kConverged;
    report.message = kBegin + words;
    return outcome;
  }
  fillReport(found, report);
  report.doubts = doubts(found);
  CycleCoordinates coordinates;
  coordinates.requested = problem.free;
  coordinates.unobservable = found.estimate.unobservable;
  conclude(model, found.estimate, coordinates, outcome.state, report);
  report.message = successInWords(found.summary, coordinates.unobservable.size());
  for (const std::string& doubt : report.doubts) {
    report.message += " " + doubt;
  }
  return outcome;
}

}  // namespace sac
