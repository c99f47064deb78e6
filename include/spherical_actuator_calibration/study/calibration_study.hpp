#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "spherical_actuator_calibration/emulation/sample_simulation.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"

namespace sac {

/// Monte-Carlo study: the same session, measured on many made actuators with many noises.
struct StudyOptions {
  Actuator nominal;
  SessionPlan plan;
  TrackerUse tracker = TrackerUse::kPosesWithoutCurrent;
  SampleNoise noise;
  ManufacturingErrors errors;
  EstimationOptions estimation;
};

/// Groups that errors are told for.
enum class ParameterGroup { kOffsets, kJointAxes, kPoles, kCoils, kEffects };
inline constexpr std::size_t kParameterGroups = 5;
/// offsets, joint_axes, poles, coils, effects.
const char* groupName(ParameterGroup group);

/// What is told of one group of parameters after one trial.
struct GroupTally {
  std::uint32_t parameters = 0;
  std::uint32_t covered = 0;   ///< truth within the 95 % interval
  double squared_error = 0.0;  ///< sum [rad²]
  double squared_bound = 0.0;  ///< variances of the Cramér–Rao bound, sum [rad²]
};
using GroupTallies = std::array<GroupTally, kParameterGroups>;

/// One trial: all cycles in sequence, then the refinement.
struct StudyTrial {
  std::uint64_t seed = 0;
  bool sequence_converged = false;  ///< every cycle before the refinement succeeded
  bool refine_converged = false;
  GroupTallies sequence;  ///< after the sequence; empty when it did not converge
  GroupTallies refined;   ///< after the refinement; empty when it did not converge
};

/// Runs one trial. The seed decides actuator and noise. Throws ConfigError when the options are not
/// valid.
StudyTrial runTrial(const StudyOptions& options, std::uint64_t seed);

/// Runs the trials of the seeds first, first + stride, … below `end`, on `threads` threads, in the
/// order of their seeds. `progress`, when given, is told the share done (0 to 1).
std::vector<StudyTrial> runTrials(const StudyOptions& options,
                                  std::uint64_t first,
                                  std::uint64_t end,
                                  std::uint64_t stride,
                                  unsigned threads,
                                  const std::function<void(double)>& progress = {});

/// Errors over trials of one group, or of all.
struct StudyErrors {
  double rms_error = 0.0;  ///< root of the mean square over parameters and trials [rad]
  double rms_bound = 0.0;  ///< the same at the Cramér–Rao bound [rad]
  double coverage = 0.0;   ///< share of parameters within their 95 % interval
  double ratio() const { return rms_error / rms_bound; }
};

/// Errors after one of the stages; NaN where no trial has any.
struct StageSummary {
  std::size_t trials = 0;
  std::size_t converged = 0;
  std::array<StudyErrors, kParameterGroups> groups;
  StudyErrors all;
};

/// Summary of trials, after the sequence and after the refinement. It depends on the trials alone,
/// not on their order.
StageSummary summarizeSequence(std::vector<StudyTrial> trials);
StageSummary summarizeRefinement(std::vector<StudyTrial> trials);

}  // namespace sac
