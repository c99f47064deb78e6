#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

void validateRest(const SampleBuilderOptions& options) {
  requireInRange("rest_window", options.rest_window, ValueRange::positive("s"));
  requireInRange("largest_joint_spread", options.largest_joint_spread, ValueRange::positive("rad"));
  requireInRange("largest_joint_drift", options.largest_joint_drift, ValueRange::positive("rad"));
  requireInRange("largest_orientation_motion",
                 options.largest_orientation_motion,
                 ValueRange::positive("rad"));
  requireInRange("settle_after_motion", options.settle_after_motion, ValueRange::nonNegative("s"));
  requireInRange("guard_before_motion", options.guard_before_motion, ValueRange::nonNegative("s"));
  // Shorter, no dwell could hold a segment; longer, memory would no longer be bounded.
  requireInRange("largest_dwell",
                 options.largest_dwell,
                 ValueRange::closed(options.rest_window + options.settle_after_motion +
                                        options.guard_before_motion + options.smallest_duration,
                                    3600.0,
                                    "s"));
}

void validateCurrents(const SampleBuilderOptions& options) {
  requireInRange("current_threshold", options.current_threshold, ValueRange::positive("A"));
  requireInRange("current_tolerance", options.current_tolerance, ValueRange::positive("A"));
  requireInRange("settle_after_current_change",
                 options.settle_after_current_change,
                 ValueRange::nonNegative("s"));
  requireInRange("guard_before_current_change",
                 options.guard_before_current_change,
                 ValueRange::nonNegative("s"));
}

void validateMeans(const SampleBuilderOptions& options) {
  requireInRange("smallest_duration", options.smallest_duration, ValueRange::positive("s"));
  requireInRange("smallest_count", options.smallest_count, ValueRange::closed(3.0, 1e6));
  requireInRange("outlier_factor", options.outlier_factor, ValueRange::closed(3.0, 1e6));
  requireInRange("joint_stddev_floor", options.joint_stddev_floor, ValueRange::nonNegative("rad"));
  requireInRange(
      "orientation_stddev_floor", options.orientation_stddev_floor, ValueRange::nonNegative("rad"));
  requireInRange(
      "torque_stddev_floor", options.torque_stddev_floor, ValueRange::nonNegative("N·m"));
}

void validateStreams(const SampleBuilderOptions& options) {
  requireInRange("largest_gap", options.largest_gap, ValueRange::positive("s"));
  requireInRange("stream_timeout", options.stream_timeout, ValueRange::closed(0.01, 60.0, "s"));
  requireInRange("clock_reset", options.clock_reset, ValueRange::positive("s"));
  requireInRange("largest_jump", options.largest_jump, ValueRange::positive("s"));
}

}  // namespace

void validate(const SampleBuilderOptions& options) {
  validateMeans(options);
  validateCurrents(options);
  validateStreams(options);
  validateRest(options);
}

SampleBuilderOptions restOptions(SampleBuilderOptions options, bool has_joints) {
  if (!has_joints) {
    options.largest_joint_spread = options.largest_orientation_motion;
  }
  return options;
}

}  // namespace sac
