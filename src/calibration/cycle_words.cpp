#include "cycle_words.hpp"

#include <algorithm>

#include "cycle_checks.hpp"
#include "cycle_demand.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

std::string cycleInWords(const CycleRequest& request) {
  switch (request.cycle) {
    case Cycle::kJoint:
      return "Joint";
    case Cycle::kPoles:
      return "Poles and coil " + std::to_string(numberOrZero(request.coil));
    case Cycle::kCoil:
      return "Coil " + std::to_string(numberOrZero(request.coil));
    case Cycle::kMotion:
      return "Motion";
    case Cycle::kRefine:
      break;
  }
  return "All parameters";
}

/// Names what stays open across the parameters, and what to do about it; or empty.
std::string openDirectionsInWords(const std::vector<OpenDirection>& open,
                                  std::size_t unknowns,
                                  const std::string& coarse) {
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
  if (!coarse.empty()) {
    return words + ". " + coarse;
  }
  const bool is_turned = open.front().name.find("rotation") != std::string::npos;
  return words + (is_turned ? ". Measure the orientation at 3 or more poses."
                            : ". No sample tells them apart: add poses turned about all axes; what "
                              "is stated of each of them is certain only together.");
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

}  // namespace

std::string refusal(const CalibrationModel& model,
                    const CalibrationState& state,
                    const CycleRequest& request,
                    const std::vector<Observation>& observations) {
  const ParameterSpace& space = model.space();
  if (request.cycle == Cycle::kJoint && space.joints() == 0) {
    return "The description has no joints: there is nothing to calibrate at level 1. Calibrate "
           "poles and coils.";
  }
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
  const CycleDemand demand = demandOf(request.cycle, space.poles());
  if (request.cycle == Cycle::kJoint && observations.size() < demand.needed) {
    return format(
        "%zu samples have an orientation: capture at least %zu poses with the tracker on "
        "(%zu are advised).",
        observations.size(),
        demand.needed,
        demand.advised);
  }
  if (observations.empty()) {
    return needs_coil ? "No sample has a torque with only coil " +
                            std::to_string(numberOrZero(request.coil)) +
                            " excited: capture poses with that coil on."
                      : "No sample can serve: capture poses first.";
  }
  return {};
}

std::string failure(const EstimationProblem& problem,
                    const Estimate& estimate,
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
  const std::string words = contradiction(problem, estimate, options);
  return words.empty() ? words : cycle + words;
}

std::string successInWords(const CycleRequest& request,
                           const CycleReport& report,
                           std::size_t unknowns,
                           const std::string& coarse,
                           const std::vector<std::string>& advice) {
  std::string words = cycleInWords(request) +
                      format(" calibrated from %u samples in %u iterations: ",
                             report.samples_used,
                             report.iterations) +
                      errorInWords(report) + ".";
  if (report.samples_rejected > 0) {
    words += format(" %u samples rejected as outliers.", report.samples_rejected);
  }
  words += openDirectionsInWords(report.open_directions, unknowns, coarse);
  for (const std::string& sentence : report.doubts) {
    words += " " + sentence;
  }
  for (const std::string& sentence : advice) {
    words += " " + sentence;
  }
  return words;
}

}  // namespace sac
