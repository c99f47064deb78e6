#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"

namespace sac {
namespace {

/// One number of a section of the file.
struct Entry {
  const char* section;
  const char* key;
  const char* unit;
  double ActuatorDimensions::*value;
};

constexpr Entry kEntries[] = {
    {"rotor", "radius", "m", &ActuatorDimensions::rotor_radius},
    {"rotor", "hoop_thickness", "m", &ActuatorDimensions::hoop_thickness},
    {"rotor", "hoop_height", "m", &ActuatorDimensions::hoop_height},
    {"rotor", "hoop_density", "kg/m3", &ActuatorDimensions::hoop_density},
    {"rotor", "pole_radius", "m", &ActuatorDimensions::pole_radius},
    {"rotor", "pole_height", "m", &ActuatorDimensions::pole_height},
    {"rotor", "magnet_density", "kg/m3", &ActuatorDimensions::magnet_density},
    {"rotor", "shaft_radius", "m", &ActuatorDimensions::shaft_radius},
    {"rotor", "shaft_length", "m", &ActuatorDimensions::shaft_length},
    {"stator", "inner_shell_radius", "m", &ActuatorDimensions::inner_shell_radius},
    {"stator", "outer_shell_radius", "m", &ActuatorDimensions::outer_shell_radius},
    {"stator", "coil_radius", "m", &ActuatorDimensions::coil_radius},
    {"stator", "coil_height", "m", &ActuatorDimensions::coil_height},
    {"limits", "torque", "N.m", &ActuatorDimensions::torque_limit},
    {"limits", "tilt_rate", "rad/s", &ActuatorDimensions::tilt_rate_limit},
    {"limits", "spin_rate", "rad/s", &ActuatorDimensions::spin_rate_limit},
};

void readSection(const YamlMap& map, const std::string& section, ActuatorDimensions& dimensions) {
  for (const Entry& entry : kEntries) {
    if (section == entry.section) {
      double& value = dimensions.*entry.value;
      value = map.number(entry.key, ValueRange::positive(entry.unit), value);
    }
  }
}

ActuatorDimensions readWhole(const YamlMap& file) {
  const ActuatorDimensions dimensions = readDimensions(file);
  file.finish();
  return dimensions;
}

}  // namespace

void validate(const ActuatorDimensions& dimensions) {
  for (const Entry& entry : kEntries) {
    requireInRange(std::string("dimensions.") + entry.section + "." + entry.key,
                   dimensions.*entry.value,
                   ValueRange::positive(entry.unit));
  }
  if (dimensions.hoop_thickness + dimensions.pole_height >= dimensions.rotor_radius) {
    throw ConfigError(
        "dimensions.rotor.radius: it is less than hoop_thickness and pole_height together.");
  }
  if (dimensions.inner_shell_radius >= dimensions.outer_shell_radius) {
    throw ConfigError(
        "dimensions.stator.inner_shell_radius: it must be less than outer_shell_radius.");
  }
  const double reach = std::hypot(dimensions.rotor_radius, 0.5 * dimensions.hoop_height);
  if (reach >= dimensions.outer_shell_radius - dimensions.coil_height) {
    throw ConfigError(
        "dimensions.stator.coil_height: the coils reach into the rotor; they begin at "
        "outer_shell_radius.");
  }
}

ActuatorDimensions readDimensions(const YamlMap& file) {
  ActuatorDimensions dimensions;
  if (!file.has("dimensions")) {
    return dimensions;
  }
  const YamlMap map = file.map("dimensions");
  for (const char* const section : {"rotor", "stator", "limits"}) {
    if (map.has(section)) {
      readSection(map.map(section), section, dimensions);
    }
  }
  validate(dimensions);
  return dimensions;
}

ActuatorDimensions loadDimensions(const std::string& path) {
  return readWhole(YamlMap::parse(readInputFile(path, kLargestConfiguration), path));
}

ActuatorDimensions parseDimensions(const std::string& text, const std::string& name) {
  return readWhole(YamlMap::parse(text, name));
}

}  // namespace sac
