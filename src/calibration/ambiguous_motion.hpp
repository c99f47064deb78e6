#pragma once

#include <string>

#include "spherical_actuator_calibration/estimation/estimator.hpp"
#include "spherical_actuator_calibration/motion/motion_estimator.hpp"

namespace sac {

/// Why other axes may explain a motion as well; empty: they do not. Poles and coils that hardly
/// move the rotor have several minima between the drawing and where they are: motions without
/// excitation, which told axes to 3 to 11 mrad, ended 5 to 67 standard deviations off, and fitted;
/// those that told all to 2.4 mrad were right. What all axes have in common, as by a tracker that
/// is hardly known or that there is none of, does not count.
std::string ambiguityInWords(const MotionProblem& problem, const Estimate& estimate);

}  // namespace sac
