#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"

namespace sac {

/// What a motion tells of strengths that differ.
struct UnevenStrengths {
  std::string words;        ///< in a sentence; empty: they do not differ
  bool stands_out = false;  ///< the one that it names, beyond doubt
};

/// Whether a motion fits clearly better where each coil and pole has a strength of its own. A coil
/// that is 0.1 % stronger than the others shows here, long before windows do not fit, and shifts
/// axes beyond their intervals.
///
/// `problem` was solved at `x`, and has no strengths. `silent`: coils without current. Takes less
/// time than the solution, and some 0.2 s however long the recording is. (doc/motion.md, How)
UnevenStrengths unevenStrengths(const MotionProblem& problem,
                                const Eigen::VectorXd& x,
                                const std::vector<std::size_t>& silent,
                                const CalibrationConfig& config);

}  // namespace sac
