#pragma once

#include <Eigen/Core>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// At x, with what the noise of readings may make of them.
WindowMeansMisfit meansOfOrientations(const MotionTerms& terms, const Eigen::VectorXd& x);

/// By how much the tracker's noise makes the variance of means over windows larger than white noise
/// of the same differences would: a filter, or a vibration, lets neighbours err alike. 1 where that
/// is chance, and where the means of windows err alike, too, or just the other way: so do a drift,
/// a clock that is off and wrong joints, which come and go with the motion and are no noise.
double trackerColour(const WindowMeansMisfit& orientations);

}  // namespace sac
