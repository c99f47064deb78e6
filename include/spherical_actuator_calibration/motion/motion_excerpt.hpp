#pragma once

#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// About so many seconds of a recording, for what need not know all of it: the middle of its
/// longest span, or of slices as many, evenly over all.
MotionRecording motionExcerpt(const MotionRecording& recording, double seconds);

}  // namespace sac
