#include "spherical_actuator_calibration/planning/planning_problem.hpp"

#include <string>
#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

void validateRequest(const PlanningProblem& problem) {
  const Cycle cycle = problem.request.cycle;
  if (cycle == Cycle::kJoint && problem.model->space().joints() == 0) {
    throw ConfigError("cycle: the actuator description has no joints to plan for.");
  }
  if (cycle != Cycle::kPoles && cycle != Cycle::kCoil) {
    return;
  }
  if (!problem.model->hasTorqueModel()) {
    throw ConfigError(
        "cycle: the actuator description has no poles, coils or torque curve; only the joint can "
        "be planned for.");
  }
  const std::size_t coils = problem.model->space().coils();
  if (!problem.request.coil || *problem.request.coil >= coils) {
    throw ConfigError("coil: " + std::to_string(numberOrZero(problem.request.coil)) +
                      " is not one of the coils 1 to " + std::to_string(coils) + ".");
  }
}

/// Median of the values [rad] or [N·m] that are told, which are above zero; else what is expected.
double medianTold(const std::vector<double>& values, double expected) {
  std::vector<double> told;
  for (const double value : values) {
    if (value > 0.0) {
      told.push_back(value);
    }
  }
  return told.empty() ? expected : medianOf(std::move(told));
}

}  // namespace

void validate(const PosePlanOptions& options, const PlanningProblem& problem) {
  validateRequest(problem);
  const auto require_count = [](const char* key, std::size_t value, std::size_t most) {
    requireInRange(
        key, static_cast<double>(value), ValueRange::closed(1.0, static_cast<double>(most)));
  };
  require_count("max_poses", options.max_poses, 1000);
  require_count("coils_per_pose", options.coils_per_pose, 1000);
  require_count("candidates", options.candidates, 100000);
  requireInRange("wanted_stddev", options.wanted_stddev, ValueRange::nonNegative("rad"));
  requireInRange("current",
                 options.current,
                 ValueRange{problem.estimation.current_threshold, 1e3, "A", true, false});
  if (options.patterns == PlanPatterns::kWeighing) {
    requireInRange(
        "total_current", options.total_current, ValueRange::closed(options.current, 1e6, "A"));
  }
  if (options.tilt_limit) {
    requireInRange(
        "tilt_limit",
        *options.tilt_limit,
        ValueRange{0.0, problem.model->space().nominal().workspace.tilt_limit, "rad", true, false});
  }
  requireInRange("spin_minimum", options.spin_minimum, ValueRange::closed(-100.0, 100.0, "rad"));
  requireInRange(
      "spin_maximum", options.spin_maximum, ValueRange::closed(options.spin_minimum, 100.0, "rad"));
  requireInRange("minimum_spacing", options.minimum_spacing, ValueRange::closed(0.0, kPi, "rad"));
  for (Eigen::Index k = 0; k < options.start.size(); ++k) {
    requireInRange("start", options.start[k], ValueRange::finite("rad"));
    requireInRange("joint_stddev", options.joint_stddev[k], ValueRange::nonNegative("rad"));
  }
  requireInRange("orientation_stddev", options.orientation_stddev, ValueRange::positive("rad"));
  requireInRange("torque_stddev", options.torque_stddev, ValueRange::positive("N m"));
}

PosePlanOptions withMeasuredNoise(PosePlanOptions options, const std::vector<Sample>& held) {
  std::vector<double> of_orientations;
  std::vector<double> of_torques;
  for (const Sample& sample : held) {
    of_orientations.push_back(sample.has_orientation ? sample.orientation_stddev : 0.0);
    of_torques.push_back(sample.has_torque ? sample.torque_stddev : 0.0);
  }
  options.orientation_stddev = medianTold(of_orientations, options.orientation_stddev);
  options.torque_stddev = medianTold(of_torques, options.torque_stddev);
  for (Eigen::Index joint = 0; joint < options.joint_stddev.size(); ++joint) {
    std::vector<double> of_joint;
    of_joint.reserve(held.size());
    for (const Sample& sample : held) {
      of_joint.push_back(sample.joint_stddev[joint]);
    }
    options.joint_stddev[joint] = medianTold(of_joint, options.joint_stddev[joint]);
  }
  return options;
}

}  // namespace sac
