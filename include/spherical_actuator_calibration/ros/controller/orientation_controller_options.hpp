#pragma once

#include <string>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"

namespace sac {

/// Everything about the controller node that is a matter of choice.
struct OrientationControllerNodeOptions {
  OrientationControllerOptions controller;
  std::string stator_frame = "stator";  ///< that targets must be in
};

/// Reads the private parameters of a node (config/orientation_controller.yaml, and the map
/// `dimensions` of config/actuator_dimensions.yaml). Where they have no inertia, it is that of the
/// described rotor of these dimensions. Throws ConfigError that names the key for anything unknown,
/// of the wrong type or out of range.
OrientationControllerNodeOptions readOrientationControllerOptions(const YamlMap& map,
                                                                  const Actuator& design);

}  // namespace sac
