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
  /// All coordinates near the solution, as another estimate found them; empty: nothing is known,
  /// and the prior and every delay are tried.
  Eigen::VectorXd start;
};

}  // namespace sac
