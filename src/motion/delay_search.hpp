#pragma once

#include <Eigen/Core>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/motion/delay_range.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"

namespace sac {

/// One step from the prior, with the delay of the currents that explains most.
struct DelayedStep {
  double delay = 0.0;  ///< its coordinate
  Eigen::VectorXd x;   ///< all coordinates after the step
  double left = 0.0;   ///< squared misfit after it, with what the coordinates have moved
};

/// Currents vary too fast for a start half a period off: of several delays the one with the least
/// misfit after one step, by some 30 of the windows and without the tracker. `loose`: how far each
/// coordinate may go, P standard deviations. Of a model without that delay: at the prior's.
DelayedStep searchDelay(const MotionProblem& problem,
                        const DelayRange& range,
                        const Eigen::VectorXd& loose,
                        MotionTerms& terms);

}  // namespace sac
