#pragma once

#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// Orientations of a motion, evenly over it and 120 at the most, each with the reading of the
/// joints nearest to its stamp. How late the tracker is does not matter: the standard deviation
/// holds what the rotor turns by within the usual delays of trackers. It is coarse, for mistakes
/// that turn by more.
std::vector<Sample> posesOfMotion(const MotionRecording& recording);

}  // namespace sac
