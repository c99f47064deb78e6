#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace sac {

/// Windows that did not serve, for one reason.
struct WindowsLeftOut {
  std::string reason;
  std::size_t count = 0;
};

/// What became of a recording of motion.
struct MotionSummary {
  double duration = 0.0;    ///< of the windows that served [s]
  std::size_t windows = 0;  ///< cut from the recording
  std::size_t used = 0;     ///< that served
  std::size_t values = 0;   ///< residuals of a window
  std::vector<WindowsLeftOut> left_out;
  std::size_t orientations = 0;           ///< of the tracker, that served
  std::size_t orientations_rejected = 0;  ///< outliers
  // Noise as the streams themselves tell it.
  Eigen::Vector3d joint_stddev = Eigen::Vector3d::Zero();  ///< [rad]
  double current_stddev = 0.0;                             ///< [A]
  double orientation_stddev = 0.0;                         ///< per component [rad]
  double window_chi_square = 0.0;                          ///< reduced, of the windows that served
  double orientation_chi_square = 0.0;  ///< reduced, of means over windows: 1 without drift
};

}  // namespace sac
