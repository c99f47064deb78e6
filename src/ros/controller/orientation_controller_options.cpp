#include "spherical_actuator_calibration/ros/controller/orientation_controller_options.hpp"

#include "spherical_actuator_calibration/actuator/rotor_mass.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"

namespace sac {
namespace {

Eigen::Vector3d readVector(const YamlMap& map, const char* key, const char* unit) {
  return Eigen::Vector3d(map.numbers(key, ValueRange::finite(unit), 3).data());
}

void readRotor(const YamlMap& map, RigidRotor& rotor) {
  if (map.has("inertia")) {
    rotor.inertia = readVector(map, "inertia", "kg m2").asDiagonal();
  }
  if (map.has("unbalance")) {
    rotor.unbalance = readVector(map, "unbalance", "N m");
  }
}

void readDisturbance(const YamlMap& map, DisturbanceObserverOptions& disturbance) {
  disturbance.bandwidth =
      map.number("bandwidth", disturbanceBandwidthRange(), disturbance.bandwidth);
  disturbance.largest_torque =
      map.number("largest_torque", ValueRange::positive("N m"), disturbance.largest_torque);
}

void readReference(const YamlMap& map, OrientationReferenceOptions& reference) {
  const auto positive = [&](const char* key, const char* unit, double& value) {
    value = map.number(key, ValueRange::positive(unit), value);
  };
  positive("natural_frequency", "rad/s", reference.natural_frequency);
  positive("largest_rate", "rad/s", reference.largest_rate);
  positive("largest_acceleration", "rad/s2", reference.largest_acceleration);
  reference.largest_gap =
      map.number("largest_gap", ValueRange::nonNegative("s"), reference.largest_gap);
}

/// Of all coils, each of the same resistance.
double readSquareCurrentLimit(const YamlMap& power) {
  return power.number("limit", ValueRange::positive("W")) /
         power.number("coil_resistance", ValueRange::positive("ohm"));
}

}  // namespace

OrientationControllerNodeOptions readOrientationControllerOptions(const YamlMap& map,
                                                                  const Actuator& design) {
  OrientationControllerNodeOptions options;
  OrientationControllerOptions& controller = options.controller;
  const auto positive = [](const YamlMap& from, const char* key, const char* unit, double& value) {
    value = from.number(key, ValueRange::positive(unit), value);
  };
  if (map.has("frames")) {
    options.stator_frame = map.map("frames").nonEmptyText("stator");
  }
  controller.rotor.inertia = rotorInertia(design, readDimensions(map));
  if (map.has("rotor")) {
    readRotor(map.map("rotor"), controller.rotor);
  }
  if (map.has("gains")) {
    const YamlMap gains = map.map("gains");
    positive(gains, "proportional", "1/s2", controller.gains.proportional);
    positive(gains, "derivative", "1/s", controller.gains.derivative);
  }
  if (map.has("motion_gains")) {
    const YamlMap gains = map.map("motion_gains");
    positive(gains, "proportional", "1/s2", controller.motion_gains.proportional);
    positive(gains, "derivative", "1/s", controller.motion_gains.derivative);
  }
  if (map.has("disturbance")) {
    readDisturbance(map.map("disturbance"), controller.disturbance);
  }
  positive(map, "current_limit", "A", controller.allocation.current_limit);
  positive(map, "least_singular_value", "N m/A", controller.allocation.least_singular_value);
  positive(map, "largest_age", "s", controller.largest_age);
  positive(map, "velocity_cutoff", "rad/s", controller.velocity_cutoff);
  controller.workspace_margin =
      map.number("workspace_margin", ValueRange::nonNegative("rad"), controller.workspace_margin);
  positive(map, "largest_tracking_error", "rad", controller.largest_tracking_error);
  positive(map, "total_current_limit", "A", controller.total_current_limit);
  if (map.has("power")) {
    controller.square_current_limit = readSquareCurrentLimit(map.map("power"));
  }
  if (map.has("reference")) {
    readReference(map.map("reference"), controller.reference);
  }
  acceptDiagnosticPeriod(map);
  map.finish();
  validate(controller);
  return options;
}

}  // namespace sac
