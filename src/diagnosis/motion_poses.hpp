#pragma once

#include <vector>

#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"

namespace sac {

/// Orientations of a motion, evenly over it and 120 at the most, each with the reading of the
/// joints nearest to its stamp less `delay` [s], and without those that have none within 20 ms. It
/// is coarse, for mistakes that turn by more: the standard deviation holds what the rotor turns by
/// in 10 ms.
std::vector<Sample> posesOfMotion(const MotionRecording& recording, double delay);

/// Mistakes of joints and tracker by these poses, with the delay of the tracker that explains them
/// best.
WiringDiagnosis diagnosePosesOfMotion(const Actuator& nominal,
                                      const MotionRecording& recording,
                                      const CalibrationConfig& config);

}  // namespace sac
