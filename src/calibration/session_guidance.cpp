#include "spherical_actuator_calibration/calibration/session_guidance.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>

#include "samples_per_coil.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/calibration/cycle_demand.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/calibration/sample_coverage.hpp"

namespace sac {
namespace {

bool allIdentified(const CalibrationState& state, Eigen::Index first, Eigen::Index last) {
  const auto begin = state.identified.begin();
  return std::find(begin + first, begin + last, false) == begin + last;
}

bool anyIdentified(const CalibrationState& state, Eigen::Index first, Eigen::Index last) {
  const auto begin = state.identified.begin();
  return std::find(begin + first, begin + last, true) != begin + last;
}

std::string number(std::size_t value) {
  return std::to_string(value);
}

std::string missing(std::size_t held, std::size_t advised) {
  return number(held) + " of " + number(advised) + " are held";
}

/// Finds the next step, in the order of the paper: joint, poles with one coil, the other coils;
/// then refinement, validation, file.
class Guide {
 public:
  Guide(const CalibrationModel& model,
        const std::vector<Sample>& samples,
        const SessionProgress& progress,
        const EstimationOptions& options)
      : model_(model),
        samples_(samples),
        progress_(progress),
        options_(options),
        samples_per_coil_(samplesPerCoil(model, samples, options)) {}

  std::string step() const {
    if (!progress_.plan_step.empty()) {
      return progress_.plan_step;
    }
    if (progress_.saved && samples_.empty()) {
      return "The parameters in force are saved, and no sample is in use: there is nothing to do. "
             "To calibrate anew, capture at new poses.";
    }
    if (!progress_.joint_done) {
      return jointStep();
    }
    return model_.hasTorqueModel() ? torqueStep() : closingStep();
  }

 private:
  std::string torqueStep() const {
    if (!progress_.refined && (isSeenEverywhere() || isIdentifiedOnce())) {
      return "Call refine: it identifies all parameters at once, to the best accuracy.";
    }
    if (!progress_.poles_done) {
      return polesStep();
    }
    if (const auto coil = firstOpenCoil()) {
      return coilStep(*coil);
    }
    return closingStep();
  }

  bool isIdentifiedOnce() const { return progress_.poles_done && !firstOpenCoil(); }

  /// The torques tell of every pole and coil, without enough of a coil alone for its own cycle:
  /// those of a planned session, which no paper's protocol is to follow.
  bool isSeenEverywhere() const {
    const auto is_seen = [](const Coverage& one) { return one.samples > 0; };
    return samples_per_coil_.at(referenceCoil()) < advised(Cycle::kPoles) &&
           std::all_of(progress_.poles.begin(), progress_.poles.end(), is_seen) &&
           std::all_of(progress_.coils.begin(), progress_.coils.end(), is_seen);
  }

  std::size_t advised(Cycle cycle) const { return demandOf(cycle, model_.space().poles()).advised; }

  std::string jointStep() const {
    const std::size_t held = progress_.joint.samples;
    if (progress_.joint.isSeenWell()) {
      return "Call calibrate_joint: " +
             number(selectObservations(samples_, {Cycle::kJoint}, options_).size()) +
             " samples have an orientation.";
    }
    return "Move the rotor to a new pose with each joint turned, let it rest, and call capture: " +
           missing(held, advised(Cycle::kJoint)) + " with an orientation.";
  }

  /// Coil that was excited alone most often; the first when none was.
  std::size_t referenceCoil() const {
    const auto most = std::max_element(samples_per_coil_.begin(), samples_per_coil_.end());
    return static_cast<std::size_t>(std::distance(samples_per_coil_.begin(), most));
  }

  std::string polesStep() const {
    const std::size_t coil = referenceCoil();
    const std::size_t held = samples_per_coil_.at(coil);
    if (held >= advised(Cycle::kPoles)) {
      return "Call calibrate_poles with coil " + number(numberOf(coil)) + ": " + number(held) +
             " samples have a torque of this coil alone.";
    }
    return "Excite coil " + number(numberOf(coil)) +
           " alone and capture at poses that bring each pole near it: " +
           missing(held, advised(Cycle::kPoles)) + ".";
  }

  std::optional<std::size_t> firstOpenCoil() const {
    for (std::size_t j = 0; j < progress_.coil_done.size(); ++j) {
      if (!progress_.coil_done[j]) {
        return j;
      }
    }
    return std::nullopt;
  }

  std::string coilStep(std::size_t coil) const {
    const std::size_t held = samples_per_coil_.at(coil);
    if (held >= advised(Cycle::kCoil)) {
      return "Call calibrate_coil with coil " + number(numberOf(coil)) + ": " + number(held) +
             " samples have a torque of this coil alone.";
    }
    return "Excite coil " + number(numberOf(coil)) +
           " alone and capture at poses that bring poles near it: " +
           missing(held, advised(Cycle::kCoil)) + ".";
  }

  std::string closingStep() const {
    if (progress_.contradicted) {
      return "Do not use the parameters: held-out samples contradict them. Call diagnose, look at "
             "the rejected samples, then calibrate with more poses and call validate again.";
    }
    if (progress_.saved && progress_.validation_samples == 0) {
      return "The calibration is saved, and nothing judges it: capture a few poses with validation "
             "set and call validate.";
    }
    if (progress_.saved) {
      return "Nothing is left to do: the calibration is complete and saved.";
    }
    if (progress_.validation_samples == 0) {
      return "Capture a few poses with validation set and call validate, or call save.";
    }
    return "Call validate, and save when it agrees.";
  }

  const CalibrationModel& model_;
  const std::vector<Sample>& samples_;
  const SessionProgress& progress_;
  const EstimationOptions& options_;
  std::vector<std::size_t> samples_per_coil_;
};

std::uint32_t count(std::size_t value) {
  return static_cast<std::uint32_t>(value);
}

void addCoverage(const CalibrationModel& model,
                 const SampleCoverage& seen,
                 std::size_t orientations,
                 const CalibrationState& state,
                 SessionProgress& progress) {
  const ParameterSpace& space = model.space();
  progress.joint = {count(orientations),
                    count(demandOf(Cycle::kJoint, space.poles()).advised),
                    allIdentified(state, space.joint(0), space.pole(0))};
  for (std::size_t i = 0; i < seen.poles.size(); ++i) {
    progress.poles.push_back({seen.poles[i],
                              count(kAdvisedTorquesPerPole),
                              allIdentified(state, space.pole(i), space.pole(i + 1))});
  }
  for (std::size_t j = 0; j < seen.coils.size(); ++j) {
    progress.coils.push_back({seen.coils[j],
                              count(kAdvisedTorquesPerCoil),
                              allIdentified(state, space.coil(j), space.coil(j + 1))});
  }
}

}  // namespace

SessionProgress progressOf(const CalibrationModel& model,
                           const std::vector<Sample>& samples,
                           const CalibrationState& state,
                           const EstimationOptions& options) {
  const ParameterSpace& space = model.space();
  SessionProgress progress;
  progress.torque_samples.resize(space.coils(), 0);
  for (const Sample& sample : samples) {
    progress.orientation_samples += sample.has_orientation ? 1U : 0U;
    progress.validation_samples += sample.validation ? 1U : 0U;
    if (!sample.has_torque) {
      continue;
    }
    for (const Excitation& excitation : excitedCoils(sample, options.current_threshold)) {
      ++progress.torque_samples[excitation.coil];
    }
  }
  progress.joint_done = anyIdentified(state, space.joint(0), space.pole(0));
  progress.poles_done = anyIdentified(state, space.pole(0), space.coil(0));
  for (std::size_t j = 0; j < space.coils(); ++j) {
    progress.coil_done.push_back(anyIdentified(state, space.coil(j), space.coil(j + 1)));
  }
  addCoverage(model,
              sampleCoverage(model, samples, state.belief.x, options.current_threshold),
              usefulOrientations(samples, options, demandOf(Cycle::kJoint, space.poles()).advised),
              state,
              progress);
  progress.next_cycles = nextCycles(model, samples, options);
  return progress;
}

std::string nextStep(const CalibrationModel& model,
                     const std::vector<Sample>& samples,
                     const SessionProgress& progress,
                     const EstimationOptions& options) {
  return Guide(model, samples, progress, options).step();
}

}  // namespace sac
