#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan_file.hpp"
#include "spherical_actuator_calibration/study/motion_information.hpp"
#include "spherical_actuator_calibration/study/motion_rehearsal.hpp"

namespace sac {

/// What a motion is chosen for, and among what.
struct MotionPlannerOptions {
  double duration = 60.0;  ///< [s]
  double ramp = 2.0;       ///< [s]
  MotionLimits limits;
  /// Root mean square of each coil's excitation [A]; 0: as much as total_current and the rehearsals
  /// allow.
  double excitation = 0.0;
  std::size_t candidates = 12;  ///< motions to choose from
  std::size_t rehearsals = 3;   ///< of a motion, each with another wrong model
  double model_error = 0.03;    ///< of every parameter in these, within ± [rad]
  std::uint64_t seed = 1;
  MotionSensors sensors;
  RehearsalOptions rehearsal;
};

/// Throws ConfigError that names the option and its range.
void validate(const MotionPlannerOptions& options);

/// How good a motion is: the smaller the better.
using MotionScore = std::function<double(const MotionPlan&)>;

/// Random motions within the limits, the best by the score first. Throws ConfigError when the
/// limits leave no motion.
std::vector<MotionPlan> drawMotions(const Actuator& actuator,
                                    const MotionPlannerOptions& options,
                                    const MotionScore& score);

/// A planned motion with what it is expected to tell.
struct PlannedMotionResult {
  MotionPlanRecord record;
  double excitation = 0.0;            ///< root mean square of each coil [A]
  std::vector<Rehearsal> rehearsals;  ///< of what was planned
  std::string worst_parameter;
  double worst_stddev = 0.0;  ///< [rad]
};

/// Plans a motion: the most informative of the candidates that no rehearsal brought farther from
/// its reference than by three quarters of the limit, else the one that comes least near to it. No
/// rehearsal had to fade its excitation by more than a third; that is made weaker until there is
/// such a motion.
/// `progress` is told in words what is done. Throws DataError when no excitation is small enough,
/// ConfigError when actuator or options are not valid.
PlannedMotionResult planMotion(const Actuator& actuator,
                               const MotionPlannerOptions& options,
                               const std::function<void(const std::string&)>& progress = {});

}  // namespace sac
