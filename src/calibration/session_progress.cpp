#include "spherical_actuator_calibration/calibration/session_progress.hpp"

#include <algorithm>

#include "cycle_demand.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

namespace sac {
namespace {

bool anyOf(const std::vector<bool>& identified, Eigen::Index first, Eigen::Index last) {
  const auto begin = identified.begin();
  return std::find(begin + first, begin + last, true) != begin + last;
}

bool allOf(const std::vector<bool>& identified, Eigen::Index first, Eigen::Index last) {
  const auto begin = identified.begin();
  return std::find(begin + first, begin + last, false) == begin + last;
}

}  // namespace

bool SessionProgress::hasTorques() const {
  return std::any_of(
      torque_samples.begin(), torque_samples.end(), [](std::uint32_t count) { return count > 0; });
}

bool SessionProgress::isAllIdentified() const {
  const auto is_identified = [](const Coverage& part) { return part.identified; };
  return joint.identified && std::all_of(poles.begin(), poles.end(), is_identified) &&
         std::all_of(coils.begin(), coils.end(), is_identified);
}

ProgressCounter::ProgressCounter(const CalibrationModel& model,
                                 const CalibrationState& state,
                                 const EstimationOptions& options)
    : model_(model),
      identified_(state.identified),
      current_threshold_(options.current_threshold),
      counts_(model, options),
      seen_(model, state.belief.x, options.current_threshold),
      torque_samples_(model.space().coils(), 0) {}

void ProgressCounter::add(const Sample& sample) {
  counts_.add(sample);
  seen_.add(sample);
  ++samples_;
  orientation_samples_ += sample.has_orientation ? 1U : 0U;
  validation_samples_ += sample.validation ? 1U : 0U;
  if (!sample.has_torque) {
    return;
  }
  for (const Excitation& excitation : excitedCoils(sample, current_threshold_)) {
    ++torque_samples_[excitation.coil];
  }
}

void ProgressCounter::add(const std::vector<Sample>& samples) {
  for (const Sample& sample : samples) {
    add(sample);
  }
}

SessionProgress ProgressCounter::progress() const {
  const ParameterSpace& space = model_.space();
  SessionProgress progress;
  progress.samples = samples_;
  progress.joint_samples = counts_.orientations();
  progress.samples_per_coil = counts_.perCoil();
  progress.orientation_samples = orientation_samples_;
  progress.validation_samples = validation_samples_;
  progress.torque_samples = torque_samples_;
  progress.joint_done = space.joints() == 0 || anyOf(identified_, space.joint(0), space.pole(0));
  progress.poles_done = anyOf(identified_, space.pole(0), space.coil(0));
  for (std::size_t j = 0; j < space.coils(); ++j) {
    progress.coil_done.push_back(anyOf(identified_, space.coil(j), space.coil(j + 1)));
  }
  addCoverage(progress);
  progress.next_cycles = nextCycles(model_, counts_);
  return progress;
}

Coverage ProgressCounter::coverage(std::size_t samples,
                                   std::size_t wanted,
                                   Eigen::Index first,
                                   Eigen::Index last) const {
  return {static_cast<std::uint32_t>(samples),
          static_cast<std::uint32_t>(wanted),
          allOf(identified_, first, last)};
}

void ProgressCounter::addCoverage(SessionProgress& progress) const {
  const ParameterSpace& space = model_.space();
  const SampleCoverage& seen = seen_.coverage();
  progress.joint =
      coverage(counts_.usefulOrientations(),
               space.joints() == 0 ? 0 : demandOf(Cycle::kJoint, space.poles()).advised,
               space.joint(0),
               space.pole(0));
  for (std::size_t i = 0; i < seen.poles.size(); ++i) {
    progress.poles.push_back(
        coverage(seen.poles[i], kAdvisedTorquesPerPole, space.pole(i), space.pole(i + 1)));
  }
  for (std::size_t j = 0; j < seen.coils.size(); ++j) {
    progress.coils.push_back(
        coverage(seen.coils[j], kAdvisedTorquesPerCoil, space.coil(j), space.coil(j + 1)));
  }
}

SessionProgress progressOf(const CalibrationModel& model,
                           const std::vector<Sample>& samples,
                           const CalibrationState& state,
                           const EstimationOptions& options) {
  ProgressCounter counter(model, state, options);
  counter.add(samples);
  return counter.progress();
}

}  // namespace sac
