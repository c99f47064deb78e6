#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// Whether a tracker saw the motion.
enum class HasOrientations { kNo, kYes };

/// What a motion can tell, of a space with the effects of withMotionEffects(), ascending.
std::vector<Eigen::Index> motionCoordinates(const ParameterSpace& space,
                                            HasOrientations has_orientations);

/// The cycle motion: all parameters from a recording of motion, where there is one (doc/motion.md).
/// Where the model does not know inertia, friction and delays, they are found and told, and are
/// not part of the state.
CycleOutcome runMotionCycle(const CalibrationModel& model,
                            const MotionRecording* recording,
                            const CalibrationState& state,
                            const CalibrationConfig& config);

}  // namespace sac
