#include "spherical_actuator_calibration/calibration/session_guidance.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>

#include "cycle_demand.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

/// Beside what the paper's protocol wants.
constexpr const char* kPlanned = " Fewer captures do at poses that plan_poses chooses.";

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
  Guide(const CalibrationModel& model, const SessionProgress& progress)
      : model_(model), progress_(progress) {}

  std::string step() const {
    if (!progress_.plan_step.empty()) {
      return (progress_.contradicted
                  ? "Do not use the parameters in force, which are contradicted. "
                  : "") +
             progress_.plan_step;
    }
    if (progress_.saved && progress_.samples == 0 && !progress_.contradicted) {
      return "The parameters in force are saved, and no sample is in use: there is nothing to do. "
             "To calibrate anew, capture at new poses.";
    }
    if (progress_.refused && progress_.samples > 0) {
      return "The last cycle was refused, and would be again: its report says what contradicts. "
             "Call diagnose "
             "and mend what it names, or remove those samples and capture at new poses; "
             "then run it again.";
    }
    if (progress_.samples == 0 && progress_.isAllIdentified()) {
      return closingStep();  // by a motion: there is nothing to refine
    }
    if (progress_.contradicted && progress_.isAllIdentified() && !isSeenWell()) {
      return "Do not use the parameters in force: what was held out contradicts them. Call "
             "diagnose, "
             "and check what was changed at the machine; then calibrate anew by a session of its "
             "own, as plan_poses or guided_session plans: the samples in use do not tell all "
             "parameters.";
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

  /// By samples enough for all parameters: what is identified may be so by the description.
  bool isSeenWell() const {
    const auto is_seen_well = [](const Coverage& part) { return part.isSeenWell(); };
    return progress_.joint.isSeenWell() &&
           std::all_of(progress_.poles.begin(), progress_.poles.end(), is_seen_well) &&
           std::all_of(progress_.coils.begin(), progress_.coils.end(), is_seen_well);
  }

  /// The torques tell of every pole and coil, without enough of a coil alone for its own cycle:
  /// those of a planned session, which no paper's protocol is to follow.
  bool isSeenEverywhere() const {
    const auto is_seen = [](const Coverage& one) { return one.samples > 0; };
    return progress_.samples_per_coil.at(referenceCoil()) < advised(Cycle::kPoles) &&
           std::all_of(progress_.poles.begin(), progress_.poles.end(), is_seen) &&
           std::all_of(progress_.coils.begin(), progress_.coils.end(), is_seen);
  }

  std::size_t advised(Cycle cycle) const { return demandOf(cycle, model_.space().poles()).advised; }

  std::string jointStep() const {
    const std::size_t held = progress_.joint.samples;
    if (progress_.joint.isSeenWell()) {
      return "Call calibrate_joint: " + number(progress_.joint_samples) +
             " samples have an orientation.";
    }
    return "Move the rotor to a new pose with each joint turned, let it rest, and call capture: " +
           missing(held, advised(Cycle::kJoint)) + " with an orientation.";
  }

  /// Coil that was excited alone most often; the first when none was.
  std::size_t referenceCoil() const {
    const auto most =
        std::max_element(progress_.samples_per_coil.begin(), progress_.samples_per_coil.end());
    return static_cast<std::size_t>(std::distance(progress_.samples_per_coil.begin(), most));
  }

  std::string polesStep() const {
    const std::size_t coil = referenceCoil();
    const std::size_t held = progress_.samples_per_coil.at(coil);
    if (held >= advised(Cycle::kPoles)) {
      return "Call calibrate_poles with coil " + number(numberOf(coil)) + ": " + number(held) +
             " samples have a torque of this coil alone.";
    }
    return "Excite coil " + number(numberOf(coil)) +
           " alone and capture at poses that bring each pole near it: " +
           missing(held, advised(Cycle::kPoles)) + "." + kPlanned;
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
    const std::size_t held = progress_.samples_per_coil.at(coil);
    if (held >= advised(Cycle::kCoil)) {
      return "Call calibrate_coil with coil " + number(numberOf(coil)) + ": " + number(held) +
             " samples have a torque of this coil alone.";
    }
    return "Excite coil " + number(numberOf(coil)) +
           " alone and capture at poses that bring poles near it: " +
           missing(held, advised(Cycle::kCoil)) + "." + kPlanned;
  }

  std::string closingStep() const {
    if (progress_.contradicted) {
      return "Do not use the parameters: the grade says what contradicts them. Call diagnose, look "
             "at the rejected samples, then calibrate with more poses and call validate again.";
    }
    if (progress_.removed > 0 && progress_.samples > 0) {
      return removalStep();
    }
    if (!progress_.judged) {
      return validationStep();
    }
    if (!progress_.good) {
      const std::string rest = "the grade's reason says what it is not good for.";
      return progress_.saved ? "The calibration is saved, and usable as far as it goes: " + rest
                             : "Call save: what was held out agrees, and " + rest;
    }
    return progress_.saved ? "Nothing is left to do: the calibration is complete and saved."
                           : "Call save: what was held out agrees.";
  }

  /// The parameters still have the effect of what was removed.
  std::string removalStep() const {
    const Cycle cycle = model_.hasTorqueModel() ? Cycle::kRefine : Cycle::kJoint;
    const bool is_possible = std::any_of(
        progress_.next_cycles.begin(), progress_.next_cycles.end(), [&](const CycleRequest& next) {
          return next.cycle == cycle;
        });
    return (is_possible ? "Call " : "Capture at new poses, then call ") +
           std::string(cycle == Cycle::kRefine ? "refine" : "calibrate_joint") + ": " +
           counted(progress_.removed, "sample") + " that the parameters rest on " +
           (progress_.removed == 1 ? "was" : "were") + " removed.";
  }

  std::string validationStep() const {
    if (progress_.validation_samples > 0) {
      const std::string excited = model_.hasTorqueModel() ? ", coils excited in turn," : "";
      return "The held-out samples do not judge all that is identified: capture further poses" +
             excited + " with validation set and call validate.";
    }
    return progress_.saved
               ? "The calibration is saved, and nothing judges it: capture a few poses with "
                 "validation set and call validate."
               : "Capture a few poses with validation set and call validate, or call save.";
  }

  const CalibrationModel& model_;
  const SessionProgress& progress_;
};

}  // namespace

std::string nextStep(const CalibrationModel& model, const SessionProgress& progress) {
  return Guide(model, progress).step();
}

}  // namespace sac
