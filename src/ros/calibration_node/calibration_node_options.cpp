#include "spherical_actuator_calibration/ros/calibration_node/calibration_node_options.hpp"

#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"

namespace sac {

ValueRange wantedStddevRange() {
  return ValueRange::closed(1e-9, 1.0, "rad");
}

namespace {

ValueRange captureRange(const SampleBuilderOptions& samples) {
  return ValueRange::closed(samples.smallest_duration, samples.longestCapture(), "s");
}

}  // namespace

CalibrationNodeOptions loadCalibrationNodeOptions(const ros::NodeHandle& private_node) {
  const YamlMap map = privateParameters(private_node);
  CalibrationNodeOptions options;
  options.calibration = readCalibrationConfig(map, private_node.getNamespace());
  options.directory = map.text("directory", options.directory);
  options.auto_capture = map.boolean("auto_capture", options.auto_capture);
  options.capture_duration = map.number(
      "capture_duration", captureRange(options.calibration.samples), options.capture_duration);
  options.motion_wanted_stddev =
      map.number("motion_wanted_stddev", wantedStddevRange(), options.motion_wanted_stddev);
  if (map.has(kMotionWish)) {
    options.motion_wish = map.number(kMotionWish, wantedStddevRange());
  }
  options.report_page = map.boolean("report_page", options.report_page);
  acceptDiagnosticPeriod(map);
  map.finish();
  return options;
}

}  // namespace sac
