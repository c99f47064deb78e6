#pragma once

#include <string>

#include "spherical_actuator_calibration/motion/motion_estimate.hpp"

namespace sac {

/// The error of sensors, clocks or the torque curve that residuals of a motion tell most surely,
/// what it does to the parameters, and what to do about it; "": none (doc/motion.md, How).
std::string unmodelledInWords(const MotionEstimate& found);

/// "That puts the parameters together off by …".
std::string shiftInWords(const EstimateShift& shift);

/// By how much the residuals of a motion are larger than noise, as a variance: what is told of its
/// errors is less sure by that.
double excessVariance(const MotionEstimate& found);

}  // namespace sac
