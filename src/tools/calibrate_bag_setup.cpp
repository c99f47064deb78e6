#include "calibrate_bag_setup.hpp"

#include <iostream>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_setup.hpp"

namespace sac {

CalibrateBagSetup readSetup(const CalibrateBagOptions& options, const OpenRecordings& recordings) {
  const RecordedSetup recorded =
      recordedSetup(recordings,
                    options.ns,
                    {!options.actuator_path.has_value(), !options.config_path.has_value()});
  CalibrateBagSetup setup;
  if (options.actuator_path) {
    setup.start = loadDescription(*options.actuator_path);
    std::cout << "Description: " << *options.actuator_path << "\n";
  } else if (recorded.description) {
    setup.start = *recorded.description;
    std::cout << "Description: as recorded, " << setup.start.actuator.name
              << (setup.start.actuator.serial.empty() ? "" : ", unit ")
              << setup.start.actuator.serial << "\n";
  } else {
    throw ConfigError("--actuator is needed: the recordings hold no description (topic " +
                      topicPrefix(options.ns) + kDescriptionTopic + ").");
  }
  if (options.config_path) {
    setup.config = loadCalibrationConfig(*options.config_path);
    std::cout << "Configuration: " << *options.config_path << "\n";
  } else if (recorded.config) {
    setup.config = *recorded.config;
    std::cout << "Configuration: as recorded\n";
  } else {
    std::cout << "Configuration: defaults\n";
  }
  return setup;
}

}  // namespace sac
