#include "calibrate_bag_setup.hpp"

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_setup.hpp"

namespace sac {
namespace {

/// What is off by manufacture makes no drawing "not valid any more".
void requireCalibrated(const CalibrateBagSetup& setup, const CalibrateBagOptions& options) {
  if (!setup.start.calibration) {
    throw ConfigError("--check judges a calibrated description, and " +
                      options.actuator_path.value_or("the recorded description") +
                      " is a drawing: give by --actuator what a calibration has written.");
  }
}

}  // namespace

CalibrateBagSetup readSetup(const CalibrateBagOptions& options, const OpenRecordings& recordings) {
  const RecordedSetup recorded =
      recordedSetup(recordings,
                    options.ns,
                    {!options.actuator_path.has_value(), !options.config_path.has_value()});
  CalibrateBagSetup setup;
  if (options.actuator_path) {
    setup.start = loadDescription(*options.actuator_path);
    setup.lines.push_back("Description: " + *options.actuator_path);
  } else if (recorded.description) {
    setup.start = *recorded.description;
    const Actuator& actuator = setup.start.actuator;
    setup.lines.push_back("Description: as recorded, " + actuator.name +
                          (actuator.serial.empty() ? "" : ", unit " + actuator.serial));
  } else {
    throw ConfigError("--actuator is needed: the recordings hold no description (topic " +
                      topicPrefix(options.ns) + kDescriptionTopic + ").");
  }
  if (options.check) {
    requireCalibrated(setup, options);
  }
  if (options.config_path) {
    setup.config = loadCalibrationConfig(*options.config_path);
    setup.lines.push_back("Configuration: " + *options.config_path);
  } else if (recorded.config) {
    setup.config = *recorded.config;
    setup.lines.emplace_back("Configuration: as recorded");
  } else {
    setup.lines.emplace_back("Configuration: defaults");
  }
  return setup;
}

}  // namespace sac
