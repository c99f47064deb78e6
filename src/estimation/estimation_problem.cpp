#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

void validate(const EstimationOptions& options) {
  const auto require = [](bool holds, const char* message) {
    if (!holds) {
      throw ConfigError(message);
    }
  };
  require(options.max_iterations > 0, "estimation.max_iterations must be at least 1.");
  require(options.unobservable_stddev > 0.0 && options.unobservable_stddev <= 1.0,
          "estimation.unobservable_stddev must lie in (0, 1] rad.");
  require(options.false_alarm_probability > 0.0 && options.false_alarm_probability < 0.5,
          "estimation.false_alarm_probability must lie in (0, 0.5).");
  require(options.max_rejected_fraction >= 0.0 && options.max_rejected_fraction < 0.5,
          "estimation.max_rejected_fraction must lie in [0, 0.5).");
  require(options.max_reduced_chi_square > 1.0, "estimation.max_reduced_chi_square must exceed 1.");
  require(options.max_deviation > 0.0, "estimation.max_deviation must be positive.");
  validate(options.tolerance);
  require(options.current_threshold > 0.0, "estimation.current_threshold must be positive [A].");
  require(options.min_joint_motion > 0.0, "estimation.min_joint_motion must be positive [rad].");
  require(options.default_orientation_stddev > 0.0,
          "estimation.default_orientation_stddev must be positive [rad].");
  require(options.default_torque_stddev > 0.0,
          "estimation.default_torque_stddev must be positive [N.m].");
}

ErrorMeasure errorMeasure(const std::vector<Observation>& observations) {
  const auto is_orientation = [](const Observation& observation) {
    return observation.quantity == Quantity::kOrientation;
  };
  if (std::all_of(observations.begin(), observations.end(), is_orientation)) {
    return ErrorMeasure::kOrientation;
  }
  return std::none_of(observations.begin(), observations.end(), is_orientation)
             ? ErrorMeasure::kTorque
             : ErrorMeasure::kStandardized;
}

}  // namespace sac
