#include "spherical_actuator_calibration/ros/devices/tracker_bridge_options.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/source_dir.hpp"

namespace sac {
namespace {

std::vector<std::string> bridgeNames(const TrackerBridgeOptions& options) {
  const BridgeFrames& frames = options.frames;
  return {frames.stator, frames.rotor, frames.marker, frames.tracker, frames.ft_sensor};
}

std::vector<double> bridgeNumbers(const TrackerBridgeOptions& options) {
  const MeasurementBridgeOptions& bridge = options.bridge;
  return {bridge.sensor_mount == SensorMount::kStator ? 1.0 : 0.0,
          bridge.jumps.largest_rate,
          bridge.jumps.tolerance,
          static_cast<double>(bridge.jumps.confirmations),
          bridge.clock_reset,
          bridge.largest_step,
          bridge.largest_gap,
          bridge.largest_wait,
          options.transform_wait,
          options.tracker_limits.smallest_rate,
          options.tracker_limits.largest_age,
          options.ft_sensor_limits.smallest_rate,
          options.ft_sensor_limits.largest_age};
}

TEST(TrackerBridgeOptions, TheShippedFileTellsDefaults) {
  const TrackerBridgeOptions defaults = readTrackerBridgeOptions(YamlMap::parse("{}", "b.yaml"));
  const TrackerBridgeOptions shipped =
      readTrackerBridgeOptions(YamlMap::load(SOURCE_DIR "/config/tracker_bridge.yaml"));
  EXPECT_EQ(bridgeNames(shipped), bridgeNames(defaults));
  EXPECT_EQ(bridgeNumbers(shipped), bridgeNumbers(defaults));
}

}  // namespace
}  // namespace sac
