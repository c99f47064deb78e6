#pragma once

#include <string>
#include <vector>

#include "calibrate_bag_options.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/ros/recording/open_recordings.hpp"

namespace sac {

/// What a calibration from recordings starts with.
struct CalibrateBagSetup {
  CalibratedDescription start;
  CalibrationConfig config;
  std::vector<std::string> lines;  ///< where both are from, for people
};

/// Description and configuration of the files that the command line names, else as they were
/// recorded, else (of the configuration alone) the defaults. Throws
/// ConfigError and DataError, naming file or recording; ConfigError when there is no description.
CalibrateBagSetup readSetup(const CalibrateBagOptions& options, const OpenRecordings& recordings);

}  // namespace sac
