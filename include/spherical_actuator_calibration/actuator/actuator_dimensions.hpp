#pragma once

#include <string>

namespace sac {

class YamlMap;

/// What the bodies of an actuator look like and weigh, beside the axes in its description. The
/// defaults are the paper's Tables 1 and 2; heights along the axis of a cylinder.
struct ActuatorDimensions {
  // Rotor: magnets that stand radially inside an iron hoop around the spin axis.
  double rotor_radius = 0.0565;    ///< outside of the hoop [m]
  double hoop_thickness = 0.003;   ///< radial [m]
  double hoop_height = 0.022;      ///< along the rotor's z axis [m]
  double hoop_density = 7870.0;    ///< iron [kg/m³]
  double pole_radius = 0.010;      ///< of a magnet [m]
  double pole_height = 0.020;      ///< of a magnet [m]
  double magnet_density = 7500.0;  ///< NdFeB [kg/m³]
  double shaft_radius = 0.004;     ///< of the output shaft, which is drawn only [m]
  double shaft_length = 0.145;     ///< from the centre along the rotor's z axis [m]

  // Stator: a spherical shell; the coils end flush with its outside.
  double inner_shell_radius = 0.100;  ///< [m]
  double outer_shell_radius = 0.117;  ///< [m]
  double coil_radius = 0.012;         ///< [m]
  double coil_height = 0.034;         ///< [m]

  // Limits of the joints, for planners and simulators that read the robot description.
  double torque_limit = 2.0;      ///< [N·m]
  double tilt_rate_limit = 10.0;  ///< of joints 1 and 2 [rad/s]
  double spin_rate_limit = 20.0;  ///< of joint 3 [rad/s]

  /// Distance of the magnets' centres from that of the rotor [m].
  double poleDistance() const { return rotor_radius - hoop_thickness - 0.5 * pole_height; }
  /// Distance of the coils' centres from that of the stator [m].
  double coilDistance() const { return outer_shell_radius - 0.5 * coil_height; }
};

/// Throws ConfigError, naming the key, when a value is not positive, the magnets do not fit inside
/// the hoop, or the rotor does not fit between the coils.
void validate(const ActuatorDimensions& dimensions);

/// Reads the map `dimensions` of a YAML file (config/actuator_dimensions.yaml shows every key);
/// what it leaves out keeps its default. Throws ConfigError that names file, line and key.
ActuatorDimensions loadDimensions(const std::string& path);
/// The same from a map that has other keys beside `dimensions`; the caller finishes it.
ActuatorDimensions readDimensions(const YamlMap& map);
/// The same for text in memory; `name` stands for the file in messages.
ActuatorDimensions parseDimensions(const std::string& text, const std::string& name);

}  // namespace sac
