#include "spherical_actuator_calibration/ros/devices/tracker_bridge_options.hpp"

#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"

namespace sac {
namespace {

std::string frameName(const YamlMap& map, const std::string& key, const std::string& fallback) {
  return map.has(key) ? map.nonEmptyText(key) : fallback;
}

BridgeFrames readFrames(const YamlMap& map) {
  BridgeFrames frames;
  frames.stator = frameName(map, "stator", frames.stator);
  frames.rotor = frameName(map, "rotor", frames.rotor);
  frames.marker = frameName(map, "marker", frames.marker);
  frames.tracker = map.text("tracker", frames.tracker);
  frames.ft_sensor = map.text("ft_sensor", frames.ft_sensor);
  return frames;
}

void readPlausibility(const YamlMap& map, MeasurementBridgeOptions& options) {
  JumpLimits& jumps = options.jumps;
  const ValueRange seconds = ValueRange::positive("s");
  jumps.largest_rate =
      map.number("largest_rate", ValueRange::positive("rad/s"), jumps.largest_rate);
  jumps.tolerance = map.number("tolerance", ValueRange::nonNegative("rad"), jumps.tolerance);
  constexpr int kMostConfirmations = 1000;
  jumps.confirmations =
      static_cast<int>(map.integer("confirmations", 1, kMostConfirmations, jumps.confirmations));
  options.clock_reset = map.number("clock_reset", seconds, options.clock_reset);
  options.largest_step = map.number("largest_step", seconds, options.largest_step);
}

void readInterpolation(const YamlMap& map, MeasurementBridgeOptions& options) {
  const ValueRange seconds = ValueRange::positive("s");
  options.largest_gap = map.number("largest_gap", seconds, options.largest_gap);
  options.largest_wait = map.number("largest_wait", seconds, options.largest_wait);
}

StreamLimits readLimits(const YamlMap& map, StreamLimits limits) {
  limits.smallest_rate =
      map.number("smallest_rate", ValueRange::nonNegative("Hz"), limits.smallest_rate);
  limits.largest_age = map.number("largest_age", ValueRange::positive("s"), limits.largest_age);
  return limits;
}

}  // namespace

TrackerBridgeOptions readTrackerBridgeOptions(const YamlMap& map) {
  TrackerBridgeOptions options;
  if (map.has("frames")) {
    options.frames = readFrames(map.map("frames"));
  }
  const bool on_stator = map.choice("ft_sensor_mount", {"rotor", "stator"}, "rotor") == "stator";
  options.bridge.sensor_mount = on_stator ? SensorMount::kStator : SensorMount::kRotor;
  options.transform_wait =
      map.number("transform_wait", ValueRange::closed(0.0, 10.0, "s"), options.transform_wait);
  if (map.has("plausibility")) {
    readPlausibility(map.map("plausibility"), options.bridge);
  }
  if (map.has("interpolation")) {
    readInterpolation(map.map("interpolation"), options.bridge);
  }
  if (map.has("tracker")) {
    options.tracker_limits = readLimits(map.map("tracker"), options.tracker_limits);
  }
  if (map.has("ft_sensor")) {
    options.ft_sensor_limits = readLimits(map.map("ft_sensor"), options.ft_sensor_limits);
  }
  acceptDiagnosticPeriod(map);
  map.finish();
  return options;
}

}  // namespace sac
