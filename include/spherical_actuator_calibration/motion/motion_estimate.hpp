#pragma once

#include <vector>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// What a recording of motion tells (doc/method.md).
struct MotionEstimate {
  /// Its residuals are those of windows: the index of their sample is that of the window. One that
  /// is left out for the end of a range has none.
  Estimate estimate;
  MotionSummary summary;
  WindowMeansMisfit orientations;
  /// By how much the tracker's noise, which is not white, makes the variance of means over windows
  /// larger; weights and uncertainties count it so. 1: it is white.
  double tracker_colour = 1.0;
  ResidualPace pace;
  ResidualAlignment alignment;
  std::vector<OtherFriction> frictions;  ///< beside that of the model
  JointSkew skew;
  std::vector<UnmodelledError>
      unmodelled;  ///< each that the residuals can tell, whether they do or not
  /// Windows with readings that look like the end of a sensor's range, whether they served or not.
  std::vector<WindowsLeftOut> at_end;
};

}  // namespace sac
