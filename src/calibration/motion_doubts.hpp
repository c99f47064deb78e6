#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/motion/motion_estimate.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// What may have biased an estimate from motion, in sentences: such a calibration is usable at
/// most. Empty: nothing. (doc/motion.md, How)
std::vector<std::string> motionDoubts(const MotionEstimate& found,
                                      const MotionRecording& recording);

/// Joints that are not read at once, where the residuals tell it and a parameter feels it; "": not.
std::string skewInWords(const MotionEstimate& found);

}  // namespace sac
