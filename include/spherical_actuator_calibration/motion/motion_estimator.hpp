#pragma once

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/motion_problem.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// What a recording of motion tells (doc/method.md).
struct MotionEstimate {
  /// Its residuals are those of windows: the index of their sample is that of the window. One that
  /// is left out for the end of a range has none.
  Estimate estimate;
  MotionSummary summary;
  WindowMeansMisfit orientations;
  ResidualPace pace;
  std::vector<OtherFriction> frictions;  ///< beside that of the model
  JointSkew skew;
  /// Windows with readings that look like the end of a sensor's range, whether they served or not.
  std::vector<WindowsLeftOut> at_end;
};

/// Finds the coordinates by weighted least squares over the momentum balance of windows and over
/// the tracker's orientations. Windows that contradict the others are left out. What the data
/// cannot tell keeps its prior: see unidentified_part.hpp. Never throws for poor data.
/// Precondition: the model has a torque model.
MotionEstimate estimateMotion(const MotionProblem& problem,
                              const EstimationOptions& estimation,
                              const MotionOptions& options);

}  // namespace sac
