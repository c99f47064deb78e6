#pragma once

#include "spherical_actuator_calibration/motion/motion_estimate.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"

namespace sac {

/// Finds the coordinates by weighted least squares over the momentum balance of windows and over
/// the tracker's orientations. Windows that contradict the others are left out. What the data
/// cannot tell keeps its prior: see unidentified_part.hpp. Never throws for poor data.
/// Precondition: the model has a torque model.
MotionEstimate estimateMotion(const MotionProblem& problem,
                              const EstimationOptions& estimation,
                              const MotionOptions& options);

}  // namespace sac
