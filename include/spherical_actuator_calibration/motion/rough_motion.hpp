#pragma once

#include "spherical_actuator_calibration/motion/delay_range.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"

namespace sac {

/// Mean square of the whitened residuals that one Gauss–Newton step from the prior leaves, by some
/// 30 windows of the momentum balance, with the delay of the currents in a range that explains
/// most. It takes a hundredth of a second for each delay, and tells descriptions and recordings
/// apart from which no descent finds an end.
///
/// `variance`: what one step cannot follow counts as noise of so many times that of the streams; by
/// it the prior weighs. 0: it is found. Negative where there are too few windows.
/// Precondition: the model has a torque model.
double roughMisfit(const MotionProblem& problem, double variance, const DelayRange& range);

}  // namespace sac
