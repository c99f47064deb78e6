#pragma once

#include <optional>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// The recording with currents as commands tell them, where they do so but not well
/// (MotionStreams::commanded); nothing where no span has such.
std::optional<MotionRecording> byCommands(const MotionRecording& recording);

/// Estimates by the currents as they were sampled and, where there are such, as commands tell them.
/// The latter count, for they tell the delay, unless windows fit them worse: commands that come now
/// sooner, now later tell steps that there were not. `commanded` is byCommands() of the recording
/// of the problem, which has the one that counts then, and outlives it (doc/motion.md, Commands).
MotionEstimate estimateByBetterCurrents(const std::optional<MotionRecording>& commanded,
                                        const EstimationOptions& options,
                                        MotionProblem& problem);

}  // namespace sac
