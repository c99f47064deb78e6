#pragma once

#include <vector>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// What to find from motion (doc/motion.md).
struct MotionProblem {
  const CalibrationModel* model = nullptr;  ///< with the effects of withMotionEffects()
  const MotionRecording* recording = nullptr;
  std::vector<Eigen::Index> free;  ///< coordinates to estimate, ascending
  ParameterBelief prior;
};

}  // namespace sac
