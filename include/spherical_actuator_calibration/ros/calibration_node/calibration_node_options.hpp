#pragma once

#include <optional>
#include <string>

#include <ros/node_handle.h>

#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"

namespace sac {

/// Everything about the calibration node that is a matter of choice. Defaults are those of the
/// members.
struct CalibrationNodeOptions {
  CalibrationConfig calibration;  ///< keys of config/calibration.yaml
  /// Calibration directory; empty: $ROS_HOME/spherical_actuator_calibration/<serial>.
  std::string directory;
  bool auto_capture = false;      ///< at start: every dwell is captured by itself
  double capture_duration = 1.0;  ///< of a capture that asks for none [s]
  /// Of each parameter of joints, poles and coils, that motion_progress tells the way to [rad].
  double motion_wanted_stddev = 1e-4;
  /// The same of the motion that goes on, where begin_motion was told: it keeps it here for a node
  /// that is started again.
  std::optional<double> motion_wish;
  bool report_page = true;  ///< save also makes the page of the report, which takes seconds
};

/// Key of CalibrationNodeOptions::motion_wish.
inline constexpr auto kMotionWish = "motion_wish";

/// Of motion_wanted_stddev, whoever states it.
ValueRange wantedStddevRange();

/// Reads the private parameters of a node. Throws ConfigError that names the key for anything
/// unknown, of the wrong type or out of range.
CalibrationNodeOptions loadCalibrationNodeOptions(const ros::NodeHandle& private_node);

}  // namespace sac
