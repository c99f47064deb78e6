#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/calibration/operator_advice.hpp"
#include "spherical_actuator_calibration/estimation/unidentified_part.hpp"
#include "spherical_actuator_calibration/estimation/workspace_uncertainty.hpp"

namespace sac {
namespace {

constexpr std::size_t kFewestPoses = 3;  // nine unknowns, three equations a pose

std::string cycleInWords(const CycleRequest& request) {
  switch (request.cycle) {
    case Cycle::kJoint:
      return "Joint";
    case Cycle::kPoles:
      return "Poles and coil " + std::to_string(numberOrZero(request.coil));
    case Cycle::kCoil:
      return "Coil " + std::to_string(numberOrZero(request.coil));
    case Cycle::kRefine:
      break;
  }
  return "All parameters";
}

/// Why a cycle cannot start, or empty.
std::string refusal(const CalibrationModel& model,
                    const CalibrationState& state,
                    const CycleRequest& request,
                    const std::vector<Observation>& observations) {
  const ParameterSpace& space = model.space();
  const bool needs_coil = request.cycle == Cycle::kPoles || request.cycle == Cycle::kCoil;
  if (needs_coil && !model.hasTorqueModel()) {
    return "The actuator description has no poles, coils or torque curve: only the joint can be "
           "calibrated.";
  }
  if (needs_coil && (!request.coil || *request.coil >= space.coils())) {
    return "Coil " + std::to_string(numberOrZero(request.coil)) +
           " does not exist: coils count from 1 to " + std::to_string(space.coils()) + ".";
  }
  if (request.cycle == Cycle::kCoil) {
    const auto first = state.identified.begin() + space.pole(0);
    const auto last = state.identified.begin() + space.coil(0);
    if (std::find(first, last, true) == last) {
      return "No pole is calibrated yet: run the poles cycle before coil " +
             std::to_string(numberOrZero(request.coil)) + ".";
    }
  }
  if (request.cycle == Cycle::kJoint && observations.size() < kFewestPoses) {
    return format(
        "%zu samples have an orientation: capture at least %zu poses with the tracker on "
        "(10 are advised).",
        observations.size(),
        kFewestPoses);
  }
  if (observations.empty()) {
    return needs_coil ? "No sample has a torque with only coil " +
                            std::to_string(numberOrZero(request.coil)) +
                            " excited: capture poses with that coil on."
                      : "No sample can serve: capture poses first.";
  }
  return {};
}

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

/// Why the numbers of an estimate must not be used, or empty.
std::string failure(const Estimate& estimate,
                    const CycleRequest& request,
                    const EstimationOptions& options) {
  const std::string cycle = cycleInWords(request);
  switch (estimate.termination) {
    case Termination::kTooFewObservations:
      return cycle + ": fewer measured values remain than unknowns; capture more poses.";
    case Termination::kNothingObservable:
      return cycle + ": the samples tell nothing about these parameters.";
    case Termination::kIterationLimit:
      return cycle + format(
                         ": no convergence within %d iterations; check the samples and the "
                         "nominal description.",
                         options.max_iterations);
    case Termination::kNumericalFailure:
      return cycle + ": the solver failed numerically; check the samples.";
    case Termination::kConverged:
      break;
  }
  const auto rejected = static_cast<double>(
      std::count_if(estimate.residuals.begin(),
                    estimate.residuals.end(),
                    [](const ObservationResidual& residual) { return residual.rejected; }));
  const double fraction = rejected / static_cast<double>(estimate.residuals.size());
  if (fraction > options.max_rejected_fraction) {
    return cycle + format(
                       ": the samples contradict each other (%.0f %% would be outliers); check "
                       "sensors, frames and currents.",
                       100.0 * fraction);
  }
  if (estimate.reduced_chi_square > options.max_reduced_chi_square) {
    return cycle + format(
                       ": residuals are %.0f times their stated uncertainty; the samples do not "
                       "fit the model. Check units, frames, polarity and the nominal "
                       "description.",
                       std::sqrt(estimate.reduced_chi_square));
  }
  return {};
}

/// Names what stays open across the parameters, and what to do about it; or empty.
std::string openDirectionsInWords(const std::vector<OpenDirection>& open, std::size_t unknowns) {
  if (open.empty()) {
    return {};
  }
  std::string words = format(
      " %zu of %zu directions identified; held at the prior:", unknowns - open.size(), unknowns);
  for (std::size_t k = 0; k < open.size(); ++k) {
    words += k == 0 ? " " : ", ";
    words += open[k].name;
    words += format(" (± %.2g mrad)", 1e3 * open[k].stddev);
  }
  return words + ". Measure the orientation at 3 or more poses.";
}

std::vector<ParameterEstimate> parameterEstimates(const ParameterSpace& space,
                                                  const std::vector<Eigen::Index>& requested,
                                                  const std::vector<Eigen::Index>& unobservable,
                                                  const ParameterBelief& before,
                                                  const ParameterBelief& after) {
  const Eigen::VectorXd nominal = space.reportedValues(Eigen::VectorXd::Zero(space.size()));
  const Eigen::VectorXd initial = space.reportedValues(before.x);
  const Eigen::VectorXd values = space.reportedValues(after.x);
  const Eigen::VectorXd stddevs = space.reportedStddevs(after.x, after.covariance);
  std::vector<ParameterEstimate> estimates;
  for (const Eigen::Index p : requested) {
    ParameterEstimate estimate;
    estimate.name = space.name(p);
    estimate.nominal = nominal[p];
    estimate.initial = initial[p];
    estimate.value = values[p];
    estimate.stddev = stddevs[p];
    estimate.observable = !std::binary_search(unobservable.begin(), unobservable.end(), p);
    estimates.push_back(estimate);
  }
  return estimates;
}

std::vector<SampleResidual> sampleResiduals(const std::vector<Sample>& samples,
                                            const Estimate& estimate) {
  std::vector<SampleResidual> residuals;
  residuals.reserve(estimate.residuals.size());
  for (const ObservationResidual& from : estimate.residuals) {
    SampleResidual residual;
    residual.id = samples[from.observation.sample].id;
    residual.quantity = from.observation.quantity;
    residual.residual = from.residual.norm();
    residual.standardized = from.standardized;
    residual.rejected = from.rejected;
    if (from.rejected) {
      residual.reason = format("misfit is %.1f times its uncertainty", from.standardized);
    }
    residuals.push_back(residual);
  }
  return residuals;
}

std::string errorInWords(const CycleReport& report) {
  const double before = report.error_history.front();
  const double after = report.error_history.back();
  switch (report.error_measure) {
    case ErrorMeasure::kOrientation:
      return format("mean orientation error %.3g -> %.3g mrad", 1e3 * before, 1e3 * after);
    case ErrorMeasure::kTorque:
      return format("rms torque error %.3g -> %.3g mN.m", 1e3 * before, 1e3 * after);
    case ErrorMeasure::kStandardized:
      break;
  }
  return format("rms standardized error %.3g -> %.3g", before, after);
}

std::string successInWords(const CycleRequest& request,
                           const CycleReport& report,
                           std::size_t unknowns,
                           const std::vector<std::string>& advice) {
  std::string words = cycleInWords(request) +
                      format(" calibrated from %u samples in %u iterations: ",
                             report.samples_used,
                             report.iterations) +
                      errorInWords(report) + ".";
  if (report.samples_rejected > 0) {
    words += format(" %u samples rejected as outliers.", report.samples_rejected);
  }
  words += openDirectionsInWords(report.open_directions, unknowns);
  for (const std::string& sentence : advice) {
    words += " " + sentence;
  }
  return words;
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
  report.iterations = static_cast<std::uint32_t>(estimate.iterations);
  report.error_measure = errorMeasure(observations);
  report.error_history = estimate.error_history;
  report.reduced_chi_square = estimate.reduced_chi_square;
  report.condition_number = estimate.condition_number;
  report.solve_time = estimate.solve_time;
  report.residuals = sampleResiduals(samples, estimate);
}

/// Whether a coordinate of the effects acts on any observation.
bool concerns(const EffectLayout& effects,
              Eigen::Index coordinate,
              bool any_orientation,
              const std::vector<bool>& excited) {
  switch (effects.effect(coordinate)) {
    case LaboratoryEffect::kEncoderHarmonics:
    case LaboratoryEffect::kTiltCrossAxis:
      return true;
    case LaboratoryEffect::kMarkerRegistration:
    case LaboratoryEffect::kTrackerRegistration:
      return any_orientation;
    case LaboratoryEffect::kCoilGains: {
      const Eigen::Index place = coordinate - effects.first(LaboratoryEffect::kCoilGains);
      return excited[effects.coilsWithoutGain() + static_cast<std::size_t>(place)];
    }
    default:
      return std::find(excited.begin(), excited.end(), true) != excited.end();
  }
}

}  // namespace

std::string cycleName(Cycle cycle) {
  switch (cycle) {
    case Cycle::kJoint:
      return "joint";
    case Cycle::kPoles:
      return "poles";
    case Cycle::kCoil:
      return "coil";
    case Cycle::kRefine:
      break;
  }
  return "refine";
}

std::vector<Observation> selectObservations(const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options) {
  std::vector<Observation> observations;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const Sample& sample = samples[n];
    if (sample.validation) {
      continue;
    }
    const bool wants_orientation =
        request.cycle == Cycle::kJoint || request.cycle == Cycle::kRefine;
    if (wants_orientation && sample.has_orientation) {
      observations.push_back({n, Quantity::kOrientation});
    }
    if (request.cycle == Cycle::kJoint || !sample.has_torque) {
      continue;
    }
    const std::vector<Excitation> excited = excitedCoils(sample, options.current_threshold);
    const bool serves = request.cycle == Cycle::kRefine
                            ? !excited.empty()
                            : excited.size() == 1 && excited.front().coil == request.coil;
    if (serves) {
      observations.push_back({n, Quantity::kTorque});
    }
  }
  return observations;
}

std::vector<Eigen::Index> selectCoordinates(const ParameterSpace& space,
                                            const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options) {
  std::vector<Eigen::Index> coordinates;
  const auto add = [&](Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index p = first; p < last; ++p) {
      coordinates.push_back(p);
    }
  };
  if (request.cycle == Cycle::kJoint || request.cycle == Cycle::kRefine) {
    add(0, space.pole(0));
  }
  std::vector<bool> excited(space.coils(), false);
  if (request.cycle == Cycle::kPoles || request.cycle == Cycle::kCoil) {
    excited.at(request.coil.value()) = true;
  } else if (request.cycle == Cycle::kRefine) {
    for (const Observation& observation : selectObservations(samples, request, options)) {
      if (observation.quantity == Quantity::kTorque) {
        for (const Excitation& e :
             excitedCoils(samples[observation.sample], options.current_threshold)) {
          excited.at(e.coil) = true;
        }
      }
    }
  }
  const bool any_coil = std::find(excited.begin(), excited.end(), true) != excited.end();
  if (request.cycle == Cycle::kPoles || (request.cycle == Cycle::kRefine && any_coil)) {
    add(space.pole(0), space.coil(0));
  }
  for (std::size_t j = 0; j < excited.size(); ++j) {
    if (excited[j]) {
      add(space.coil(j), space.coil(j) + ParameterSpace::kPerAxis);
    }
  }
  if (request.cycle == Cycle::kRefine) {
    const bool any_orientation =
        std::any_of(samples.begin(), samples.end(), [](const Sample& sample) {
          return sample.has_orientation && !sample.validation;
        });
    for (Eigen::Index e = 0; e < space.effects().size(); ++e) {
      if (concerns(space.effects(), e, any_orientation, excited)) {
        coordinates.push_back(space.effect() + e);
      }
    }
  }
  return coordinates;
}

CycleOutcome runCycle(const CalibrationModel& model,
                      const std::vector<Sample>& samples,
                      const CalibrationState& state,
                      const CycleRequest& request,
                      const EstimationOptions& options) {
  CycleOutcome outcome{{}, state};
  CycleReport& report = outcome.report;
  report.cycle = request.cycle;
  report.coil = request.coil;

  EstimationProblem problem;
  problem.model = &model;
  problem.samples = &samples;
  problem.observations = selectObservations(samples, request, options);
  report.message = refusal(model, state, request, problem.observations);
  if (!report.message.empty()) {
    return outcome;
  }
  const std::vector<Eigen::Index> requested =
      selectCoordinates(model.space(), samples, request, options);
  const std::vector<Eigen::Index> unexcited =
      unexcitedAxes(model.space(), samples, problem.observations, options.min_joint_motion);
  const bool frees_joints = requested.front() == 0;
  if (frees_joints && unexcited.size() == 2 * kJoints) {
    report.message = "The rotor stands still in all samples: capture poses with each joint moved.";
    return outcome;
  }
  std::set_difference(requested.begin(),
                      requested.end(),
                      unexcited.begin(),
                      unexcited.end(),
                      std::back_inserter(problem.free));
  problem.prior = state.belief;

  const Estimate estimate = sac::estimate(problem, options);
  report.message = failure(estimate, request, options);
  std::vector<Eigen::Index> unobservable = estimate.unobservable;
  if (frees_joints) {
    unobservable.insert(unobservable.end(), unexcited.begin(), unexcited.end());
    std::sort(unobservable.begin(), unobservable.end());
  }
  const std::vector<std::string> advice = adviceForUnobservable(
      model, samples, problem.observations, request, state.belief.x, unobservable);
  if (!report.message.empty()) {
    for (const std::string& sentence : advice) {
      report.message += " " + sentence;
    }
    return outcome;
  }

  fillReport(samples, problem.observations, estimate, report);
  report.success = true;
  report.open_directions =
      nameOpenDirections(model.space(), estimate.open_directions, estimate.belief);
  report.message =
      successInWords(request, report, problem.free.size() - estimate.unobservable.size(), advice);
  const std::vector<Eigen::Index> in_directions = coordinatesOf(estimate.open_directions);
  std::vector<Eigen::Index> open;
  std::set_union(unobservable.begin(),
                 unobservable.end(),
                 in_directions.begin(),
                 in_directions.end(),
                 std::back_inserter(open));
  report.estimates =
      parameterEstimates(model.space(), requested, open, state.belief, estimate.belief);
  outcome.state.belief = estimate.belief;
  for (const Eigen::Index p : requested) {
    if (!std::binary_search(open.begin(), open.end(), p)) {
      outcome.state.identified[static_cast<std::size_t>(p)] = true;
    }
  }
  for (const Eigen::Index p : in_directions) {
    outcome.state.identified[static_cast<std::size_t>(p)] = false;
  }
  const WorkspaceUncertainty uncertainty = workspaceUncertainty(model, outcome.state.belief);
  report.orientation_uncertainty = uncertainty.orientation;
  report.torque_uncertainty = uncertainty.torque;
  return outcome;
}

}  // namespace sac
