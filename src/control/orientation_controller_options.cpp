#include "spherical_actuator_calibration/control/orientation_controller_options.hpp"

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {

void validate(const OrientationControllerOptions& options) {
  validate(options.rotor);
  validate(options.gains);
  validate(options.motion_gains);
  validate(options.disturbance);
  validate(options.reference);
  requireInRange("current_limit", options.allocation.current_limit, ValueRange::positive("A"));
  requireInRange("least_singular_value",
                 options.allocation.least_singular_value,
                 ValueRange::positive("N m/A"));
  requireInRange("largest_age", options.largest_age, ValueRange::positive("s"));
  requireInRange("velocity_cutoff", options.velocity_cutoff, ValueRange::positive("rad/s"));
  requireInRange("workspace_margin", options.workspace_margin, ValueRange::nonNegative("rad"));
  requireInRange(
      "largest_tracking_error", options.largest_tracking_error, ValueRange::positive("rad"));
  requireInRange("total_current_limit", options.total_current_limit, ValueRange::positive("A"));
  if (!(options.square_current_limit > 0.0)) {
    throw ConfigError("square_current_limit: it must be above 0 A2.");
  }
}

}  // namespace sac
