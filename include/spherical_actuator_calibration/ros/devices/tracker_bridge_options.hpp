#pragma once

#include <string>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"
#include "spherical_actuator_calibration/streams/measurement_bridge.hpp"

namespace sac {

/// Names of the tf2 frames that the bridge works with.
struct BridgeFrames {
  std::string stator = "stator";
  std::string rotor = "rotor";
  std::string marker = "marker";
  std::string tracker;    ///< poses must be in it; empty: the one that each pose names
  std::string ft_sensor;  ///< wrenches must be in it; empty: the one that each wrench names
};

/// Everything about the bridge that is a matter of choice: keys of config/tracker_bridge.yaml.
struct TrackerBridgeOptions {
  BridgeFrames frames;
  MeasurementBridgeOptions bridge;
  double transform_wait = 0.2;  ///< for a registration that is not there yet [s]
  StreamLimits tracker_limits = {50.0, 0.5};
  StreamLimits ft_sensor_limits = {100.0, 0.5};
};

/// Reads the private parameters of a node. Throws ConfigError that names the key for anything
/// unknown, of the wrong type or out of range.
TrackerBridgeOptions readTrackerBridgeOptions(const YamlMap& map);

}  // namespace sac
