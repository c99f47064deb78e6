#include "spherical_actuator_calibration/ros/emulation_node/lab_emulator_options.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"

namespace sac {
namespace {

Eigen::Vector3d readVector(const YamlMap& map, const char* key, const char* unit) {
  return Eigen::Vector3d(map.numbers(key, ValueRange::finite(unit), 3).data());
}

/// Diagonal, or xx, yy, zz, xy, xz, yz.
Eigen::Matrix3d readInertia(const YamlMap& map, const char* key) {
  const std::vector<double> entries = map.numbers(key, ValueRange::finite("kg m²"));
  if (entries.size() != 3 && entries.size() != 6) {
    map.fail(key, "has either 3 numbers, xx, yy, zz, or 6, with xy, xz, yz after them.");
  }
  Eigen::Matrix3d inertia = Eigen::Vector3d(entries.data()).asDiagonal();
  if (entries.size() == 6) {
    inertia(0, 1) = inertia(1, 0) = entries[3];
    inertia(0, 2) = inertia(2, 0) = entries[4];
    inertia(1, 2) = inertia(2, 1) = entries[5];
  }
  return inertia;
}

/// "x y z qx qy qz qw" of a frame in another one, as static_transform_publisher takes it.
Eigen::Isometry3d readTransform(const YamlMap& map, const char* key) {
  std::istringstream text(map.nonEmptyText(key));
  Eigen::Vector3d position;
  Eigen::Vector4d quaternion;
  text >> position[0] >> position[1] >> position[2];
  text >> quaternion[0] >> quaternion[1] >> quaternion[2] >> quaternion[3];
  if (text.fail() || !(text >> std::ws).eof() || !position.allFinite() ||
      !isUnit(Eigen::Quaterniond(quaternion))) {
    map.fail(key, "is no transform \"x y z qx qy qz qw\" with a unit quaternion.");
  }
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = position;
  X.linear() = Eigen::Quaterniond(quaternion).normalized().toRotationMatrix();
  return X;
}

Registration readRegistration(const YamlMap& map) {
  Registration registration;
  registration.X_stator_tracker = readTransform(map, "stator_tracker");
  registration.X_rotor_marker = readTransform(map, "rotor_marker");
  registration.X_rotor_sensor = readTransform(map, "rotor_ft_sensor");
  return registration;
}

ManufacturingErrors readErrors(const YamlMap& map) {
  const ValueRange angle = ValueRange::nonNegative("rad");
  ManufacturingErrors errors;
  errors.joint_offset = map.number("joint_offset", angle);
  errors.joint_axis = map.number("joint_axis", angle);
  errors.pole_angle = map.number("pole_angle", angle);
  errors.coil_angle = map.number("coil_angle", angle);
  errors.strength = map.number("strength", ValueRange::nonNegative());
  errors.curve_stretch = map.number("curve_stretch", ValueRange::finite(), errors.curve_stretch);
  return errors;
}

TrackerOptions readTracker(const YamlMap& map) {
  TrackerOptions tracker;
  tracker.stream.rate = map.number("rate", ValueRange::closed(1.0, 2000.0, "Hz"));
  tracker.orientation_noise = map.number("orientation_noise", ValueRange::nonNegative("rad"));
  tracker.position_noise = map.number("position_noise", ValueRange::nonNegative("m"));
  tracker.glitch = map.number("outlier", ValueRange::nonNegative("rad"));
  return tracker;
}

WrenchSensorOptions readForceTorqueSensor(const YamlMap& map) {
  WrenchSensorOptions sensor;
  sensor.stream.rate = map.number("rate", ValueRange::closed(1.0, 2000.0, "Hz"));
  sensor.force_noise = map.number("force_noise", ValueRange::nonNegative("N"));
  sensor.torque_noise = map.number("torque_noise", ValueRange::nonNegative("N m"));
  sensor.force_bias = readVector(map, "force_bias", "N");
  sensor.torque_bias = readVector(map, "torque_bias", "N m");
  sensor.glitch = map.number("outlier", ValueRange::nonNegative("N m"));
  return sensor;
}

BearingFriction readFriction(const YamlMap& map) {
  BearingFriction friction;
  friction.viscous = map.number("viscous", ValueRange::nonNegative("N m s"), friction.viscous);
  friction.coulomb = map.number("coulomb", ValueRange::nonNegative("N m"), friction.coulomb);
  friction.transition =
      map.number("transition", ValueRange::positive("rad/s"), friction.transition);
  return friction;
}

StreamDelays readDelays(const YamlMap& map) {
  StreamDelays delays;
  const ValueRange range = ValueRange::nonNegative("s");
  delays.joints = map.number("joints", range, delays.joints);
  delays.currents = map.number("currents", range, delays.currents);
  delays.tracker = map.number("tracker", range, delays.tracker);
  delays.ft_sensor = map.number("ft_sensor", range, delays.ft_sensor);
  validate(delays);
  return delays;
}

void readAmplifier(const YamlMap& map, LabEmulatorOptions& options) {
  options.amplifier.time_constant = map.number("time_constant", ValueRange::nonNegative("s"));
  options.amplifier.watchdog = map.number("watchdog", ValueRange::positive("s"));
  options.amplifier.delay =
      map.number("delay", ValueRange::nonNegative("s"), options.amplifier.delay);
  options.currents.noise = map.number("noise", ValueRange::nonNegative("A"));
  options.currents.quantisation = 0.0;  // the registers'
}

}  // namespace

LabEmulatorOptions loadLabEmulatorOptions(const ros::NodeHandle& private_node) {
  const YamlMap map = privateParameters(private_node);
  LabEmulatorOptions options;
  options.seed =
      static_cast<std::uint64_t>(map.integer("seed", 0, std::numeric_limits<std::int32_t>::max()));
  options.truth = map.text("truth", options.truth);
  options.errors = readErrors(map.map("errors"));
  const YamlMap load = map.map("load");
  options.load.weight = load.number("weight", ValueRange::nonNegative("N"));
  options.load.unbalance = readVector(load, "unbalance", "N m");
  options.inertia = readInertia(load, "inertia");
  if (map.has("friction")) {
    options.friction = readFriction(map.map("friction"));
  }
  if (map.has("delays")) {
    options.delays = readDelays(map.map("delays"));
  }
  const YamlMap fixture = map.map("fixture");
  options.fixture.speed = fixture.number("speed", ValueRange::positive("rad/s"));
  options.fixture.acceleration = fixture.number("acceleration", ValueRange::positive("rad/s²"));
  options.mechanical_stop =
      fixture.number("mechanical_stop", ValueRange::open(0.0, kGimbalLock, "rad"));
  const YamlMap frames = map.map("frames");
  options.stator_frame = frames.nonEmptyText("stator");
  options.tracker_frame = frames.nonEmptyText("tracker");
  options.ft_sensor_frame = frames.nonEmptyText("ft_sensor");
  options.registration = readRegistration(map.map("registration"));
  const YamlMap joints = map.map("joints");
  options.joints.noise = joints.number("noise", ValueRange::nonNegative("rad"));
  options.joints.quantisation = 0.0;  // the registers'
  options.tracker = readTracker(map.map("tracker"));
  options.ft_sensor = readForceTorqueSensor(map.map("ft_sensor"));
  readAmplifier(map.map("amplifier"), options);
  options.joint_sensor = readJointSensorOptions(map.map("joint_sensor"));
  options.coil_driver = readCurrentAmplifierOptions(map.map("coil_driver"));
  const auto require_tcp = [&](const char* key, const ModbusLinkOptions& link) {
    if (link.type != ModbusLinkOptions::Type::kTcp) {
      map.fail(key, "only links of type tcp can be emulated.");
    }
  };
  require_tcp("joint_sensor", options.joint_sensor.link);
  require_tcp("coil_driver", options.coil_driver.link);
  map.finish();
  return options;
}

}  // namespace sac
