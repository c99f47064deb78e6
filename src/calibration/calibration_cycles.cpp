#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "cycle_checks.hpp"
#include "cycle_conclusion.hpp"
#include "cycle_words.hpp"
#include "repeated_observations.hpp"
#include "single_effects.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/held_out_judge.hpp"
#include "spherical_actuator_calibration/calibration/operator_advice.hpp"
#include "spherical_actuator_calibration/estimation/estimator.hpp"
#include "spherical_actuator_calibration/estimation/unidentified_part.hpp"
#include "stream_noise.hpp"
#include "table_coverage.hpp"

namespace sac {
namespace {

/// Coordinates of joint axes whose joint hardly moves over the observations. Their product with a
/// joint offset would look like an axis, but it is the marker's registration.
std::vector<Eigen::Index> unexcitedAxes(const ParameterSpace& space,
                                        const std::vector<Sample>& samples,
                                        const std::vector<Observation>& observations,
                                        double least_motion) {
  std::vector<Eigen::Index> axes;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    const auto by_angle = [&](const Observation& a, const Observation& b) {
      return samples[a.sample].joint_position[joint] < samples[b.sample].joint_position[joint];
    };
    const auto [lowest, highest] =
        std::minmax_element(observations.begin(), observations.end(), by_angle);
    const double motion = samples[highest->sample].joint_position[joint] -
                          samples[lowest->sample].joint_position[joint];
    if (motion < least_motion) {
      axes.push_back(space.joint(k) + 1);
      axes.push_back(space.joint(k) + 2);
    }
  }
  return axes;
}

std::vector<SampleResidual> sampleResiduals(const std::vector<Sample>& samples,
                                            const Estimate& estimate) {
  std::vector<SampleResidual> residuals;
  residuals.reserve(estimate.residuals.size());
  for (const ObservationResidual& from : estimate.residuals) {
    residuals.push_back(reportedResidual(from, samples[from.observation.sample].id));
  }
  return residuals;
}

/// Numbers of different samples among the residuals, used and rejected.
void countSamples(const Estimate& estimate, CycleReport& report) {
  std::vector<std::size_t> used;
  std::vector<std::size_t> rejected;
  for (const ObservationResidual& residual : estimate.residuals) {
    (residual.rejected ? rejected : used).push_back(residual.observation.sample);
  }
  const auto distinct = [](std::vector<std::size_t>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return static_cast<std::uint32_t>(ids.size());
  };
  report.samples_used = distinct(used);
  report.samples_rejected = distinct(rejected);
}

void fillReport(const std::vector<Sample>& samples,
                const std::vector<Observation>& observations,
                const Estimate& estimate,
                CycleReport& report) {
  countSamples(estimate, report);
  reportIteration(estimate, report);
  report.error_measure = errorMeasure(observations);
  report.residuals = sampleResiduals(samples, estimate);
}

/// Both ascending.
std::vector<Eigen::Index> without(const std::vector<Eigen::Index>& all,
                                  const std::vector<Eigen::Index>& some) {
  std::vector<Eigen::Index> rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(rest));
  return rest;
}

/// Chooses observations and coordinates of a problem; returns why the cycle cannot start, or
/// nothing.
std::string prepare(const CalibrationState& state,
                    const CycleRequest& request,
                    const EstimationOptions& options,
                    EstimationProblem& problem,
                    CycleCoordinates& coordinates) {
  const CalibrationModel& model = *problem.model;
  const std::vector<Sample>& samples = *problem.samples;
  problem.observations = selectObservations(model.space(), samples, request, options);
  std::string reason = refusal(model, state, request, problem.observations);
  if (!reason.empty()) {
    return reason;
  }
  coordinates.requested = selectCoordinates(model.space(), samples, request, options);
  if (coordinates.requested.front() < model.space().pole(0)) {  // the joints are among them
    coordinates.unexcited =
        unexcitedAxes(model.space(), samples, problem.observations, options.min_joint_motion);
  }
  if (coordinates.unexcited.size() == 2 * kJoints) {
    return "The rotor stands still in all samples: capture poses with each joint moved.";
  }
  problem.free = without(coordinates.requested, coordinates.unexcited);
  return {};
}

/// Columns of directions that reach beyond some coordinates.
Eigen::MatrixXd beyond(const std::vector<Eigen::Index>& coordinates,
                       const Eigen::MatrixXd& directions) {
  constexpr double kLeastShare = 1e-6;
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    const Eigen::VectorXd direction = directions.col(k);
    if (1.0 - direction(coordinates).squaredNorm() > kLeastShare) {
      columns.push_back(k);
    }
  }
  return directions(Eigen::all, columns);
}

ParameterBelief beliefBefore(const CalibrationState& state, const MotionEvidence* motion) {
  return motion != nullptr ? withoutMotion(state.belief, *motion) : state.belief;
}

/// Counts what a motion told beside the samples, and tells of it. Where both contradict each other
/// the report says so.
std::string join(const ParameterSpace& space,
                 const MotionEvidence& motion,
                 Estimate& estimate,
                 CycleCoordinates& coordinates,
                 CycleReport& report) {
  const CombinedBelief all = combined(space, estimate.belief, motion);
  if (all.probability < kLeastProbability) {
    report.contradicted = true;
    report.message = format(
        "All parameters: the samples contradict the motion before them (probability %.2g); at "
        "least one of both is wrong. Check registrations, torque curve and force/torque sensor; "
        "calibrate from one of both alone to see which (a running node forgets a motion by reset).",
        all.probability);
    return {};
  }
  estimate.belief = all.belief;
  estimate.unobservable = without(estimate.unobservable, motion.told);
  estimate.ambiguous = without(estimate.ambiguous, motion.told);
  estimate.open_directions = beyond(motion.told, estimate.open_directions);
  coordinates.unexcited = without(coordinates.unexcited, motion.told);
  return format(" Combined with the motion before: both agree (probability %.2g).",
                all.probability);
}

/// Of samples that are too few to be calibrated by themselves, so that an estimate of them gets
/// lost: whether they agree with the motion before them, which stands in any case.
std::string judgedByMotion(const CalibrationModel& model,
                           const std::vector<Sample>& samples,
                           const CalibrationState& state,
                           const EstimationOptions& options,
                           CycleReport& report) {
  std::vector<Sample> judged;
  for (const Sample& sample : samples) {
    if (!sample.validation) {
      judged.push_back(sample);
      judged.back().validation = true;
    }
  }
  const HeldOutValidation found = validateHeldOut(model, judged, state, options);
  report.contradicted = found.hasVerdict() && found.probability < kLeastProbability;
  return format(
      "All parameters: the samples tell too little by themselves to find the parameters beside the "
      "motion, and %s it (probability %.2g). %s",
      report.contradicted ? "contradict" : "agree with",
      found.probability,
      report.contradicted
          ? "Check registrations, torque curve and force/torque sensor."
          : "The motion stands; more poses, of all poles and coils, would add to it.");
}

/// Axes that could lie elsewhere as well, also by what a motion told, are not identified.
void countAmbiguous(const ParameterSpace& space,
                    const Estimate& estimate,
                    CycleCoordinates& coordinates,
                    CycleReport& report) {
  if (estimate.ambiguous.empty()) {
    return;
  }
  report.doubts.push_back(ambiguityInWords(space, estimate.ambiguous));
  for (const Eigen::Index first : estimate.ambiguous) {
    coordinates.unobservable.insert(coordinates.unobservable.end(), {first, first + 1});
  }
  std::sort(coordinates.unobservable.begin(), coordinates.unobservable.end());
}

/// What is to say of observations that repeat others and are left out.
struct LeftOut {
  std::string words;
  std::vector<std::string> doubts;
};

/// Solves without the observations that repeat others, and with them where there is no noise that
/// could tell them apart.
LeftOut estimateOnce(EstimationProblem& problem,
                     const EstimationOptions& options,
                     Estimate& estimate) {
  const std::vector<RepeatedObservation> repeated =
      repeatedObservations(*problem.samples, problem.observations, options);
  if (repeated.empty()) {
    estimate = sac::estimate(problem, options);
    return {};
  }
  const std::vector<Observation> all = problem.observations;
  problem.observations = withoutRepeated(all, repeated);
  estimate = sac::estimate(problem, options);
  const bool is_converged = estimate.termination == Termination::kConverged;
  if (is_converged && areWithoutNoise(all, repeated, estimate)) {
    problem.observations = all;
    estimate = sac::estimate(problem, options);
    return {};
  }
  return {repeatedInWords(*problem.samples, all, repeated),
          stillSensorsInWords(*problem.samples, all, repeated, options)};
}

/// What keeps an estimate from being good.
std::vector<std::string> doubtsOf(const EstimationProblem& problem,
                                  const CycleRequest& request,
                                  const EstimationOptions& options,
                                  const Estimate& estimate,
                                  const LeftOut& left_out,
                                  const MotionEvidence* motion) {
  std::vector<std::string> words = left_out.doubts;
  for (std::string& one : doubts(problem, estimate, options)) {
    words.push_back(std::move(one));
  }
  if (const std::string beyond_table = tableCoverageInWords(problem, estimate, options);
      !beyond_table.empty()) {
    words.push_back(beyond_table);
  }
  // Poles and coils by themselves have few samples; the refinement judges them with all others.
  if (request.cycle == Cycle::kJoint || request.cycle == Cycle::kRefine) {
    const EffectEvidence evidence = effectEvidence(problem, estimate, options, motion);
    if (evidence.found) {
      words.push_back(evidence.found->sentence);
    } else {
      const std::vector<std::string> noise =
          noiseInWords(streamNoise(problem, estimate, options), problem.model->hasOrientationMap());
      words.insert(words.end(), noise.begin(), noise.end());
    }
    if (!evidence.untold.empty()) {
      words.push_back(evidence.untold);
    }
  }
  return words;
}

/// Whether an estimate failed for what was measured, rather than for how little.
bool isContradiction(const EstimationProblem& problem, const Estimate& estimate) {
  const bool are_few = 3 * problem.observations.size() < problem.free.size();
  return estimate.termination != Termination::kNothingObservable && !are_few;
}

/// The one place where a cycle is refused after its estimate: who names causes starts here.
void refuse(const EstimationProblem& problem,
            const Estimate& estimate,
            const std::vector<std::string>& advice,
            CycleReport& report) {
  report.contradicted = isContradiction(problem, estimate);
  for (const std::string& sentence : advice) {
    report.message += " " + sentence;
  }
}

}  // namespace

CycleOutcome runCycle(const CalibrationModel& model,
                      const std::vector<Sample>& samples,
                      const CalibrationState& state,
                      const CycleRequest& request,
                      const EstimationOptions& options,
                      const MotionEvidence* motion) {
  CycleOutcome outcome{{}, state};
  CycleReport& report = outcome.report;
  report.cycle = request.cycle;
  report.coil = request.coil;
  EstimationProblem problem{&model, &samples, {}, {}, beliefBefore(state, motion)};
  CycleCoordinates coordinates;
  report.message = prepare(state, request, options, problem, coordinates);
  if (!report.message.empty()) {
    return outcome;
  }
  Estimate estimate;
  const LeftOut left_out = estimateOnce(problem, options, estimate);
  report.message = failure(problem, estimate, request, options);
  std::string together;
  if (motion != nullptr && report.message.empty()) {
    together = join(model.space(), *motion, estimate, coordinates, report);
    if (report.contradicted) {
      return outcome;
    }
  }
  if (report.message.empty()) {
    report.doubts = doubtsOf(problem, request, options, estimate, left_out, motion);
  }
  std::set_union(estimate.unobservable.begin(),
                 estimate.unobservable.end(),
                 coordinates.unexcited.begin(),
                 coordinates.unexcited.end(),
                 std::back_inserter(coordinates.unobservable));
  const std::vector<std::string> advice = adviceForUnobservable(model,
                                                                samples,
                                                                problem.observations,
                                                                request,
                                                                state.belief.x,
                                                                options,
                                                                coordinates.unobservable);
  if (!report.message.empty()) {
    refuse(problem, estimate, advice, report);
    if (motion != nullptr && estimate.termination == Termination::kIterationLimit) {
      report.message = judgedByMotion(model, samples, state, options, report);
    }
    report.message += left_out.words;
    return outcome;
  }
  fillReport(samples, problem.observations, estimate, report);
  countAmbiguous(model.space(), estimate, coordinates, report);
  conclude(model, estimate, coordinates, request.expected_errors, outcome.state, report);
  report.message = successInWords(request,
                                  report,
                                  problem.free.size() - estimate.unobservable.size(),
                                  adviceForCoarse(model.space(), options.unobservable_stddev),
                                  advice) +
                   left_out.words + together;
  return outcome;
}

}  // namespace sac
