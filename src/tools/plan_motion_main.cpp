#include <cstdio>
#include <iostream>
#include <optional>
#include <string>

#include "command_line.hpp"
#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/rotor_mass.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/study/model_error.hpp"
#include "spherical_actuator_calibration/study/motion_planner.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

constexpr char kIntroduction[] =
    "Usage: plan_motion --actuator A.yaml --output PLAN.yaml [options]\n"
    "\n"
    "Plans a motion that calibrates the actuator: a smooth reference for its joints, and currents\n"
    "in all coils whose torque cancels by the description. Several are drawn and rehearsed with\n"
    "wrong models; of those that stay near their reference the one that tells most is planned. "
    "The\n"
    "plan holds the standard deviation that each parameter will reach. The orientation controller\n"
    "carries it out: run_motion PLAN.yaml.\n"
    "Exit status: 0 the plan is written, 2 it is not (and the reason on the standard error).\n\n";

struct PlanMotionOptions {
  std::string actuator_path;
  std::string output_path;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
  std::optional<std::string> dimensions_path;
  std::optional<double> model_error;  ///< nothing: as the description tells
  MotionPlannerOptions planner;
};

void addMotionOptions(CommandLine& line, MotionPlannerOptions& planner) {
  line.beginGroup("Motion");
  line.add("duration", planner.duration, "S", "of the motion, with its ramps");
  line.add("ramp", planner.ramp, "S", "in which it gathers and loses speed");
  line.add("tilt", planner.limits.tilt, "RAD", "of the reference's joints 1 and 2, within +-");
  line.add("rate", planner.limits.rate, "RAD/S", "of each joint of the reference");
  line.add("error", planner.limits.error, "RAD", "from the reference, at most; beyond, it stops");
  line.add("coil-current", planner.limits.coil_current, "A", "of each coil, at most");
  line.add("total-current", planner.limits.total_current, "A", "sum of all |currents|, at most");
  line.add("square-current", planner.limits.square_current, "A2", "sum of their squares, at most");
  line.add("excitation",
           planner.excitation,
           "A",
           "root mean square of each coil; 0: as much as the limits and the rehearsals allow");
}

void addChoiceOptions(CommandLine& line, PlanMotionOptions& options) {
  MotionPlannerOptions& planner = options.planner;
  line.beginGroup("Choice");
  line.add("candidates", planner.candidates, "N", "motions to choose from");
  line.add("rehearsals", planner.rehearsals, "N", "of a motion, each with another wrong model");
  line.add("model-error",
           options.model_error,
           "RAD",
           "of every parameter in them, within +-; else 30 mrad by a drawing, and four of the "
           "largest standard deviations by a calibrated description, at least 5 mrad");
  line.add("seed", planner.seed, "N", "of all that is drawn");
}

void addSensorOptions(CommandLine& line, MotionPlannerOptions& planner) {
  MotionSensors& sensors = planner.sensors;
  line.beginGroup("Sensors");
  line.add("joint-rate", sensors.joint_rate, "HZ", "of joint angles");
  line.add("joint-stddev", sensors.joint_stddev, "RAD", "of a reading");
  line.add("current-rate", sensors.current_rate, "HZ", "of measured and of set currents");
  line.add("current-stddev", sensors.current_stddev, "A", "of a coil's reading");
  line.add("tracker-rate", sensors.tracker_rate, "HZ", "0: without tracker");
  line.add("tracker-stddev", sensors.tracker_stddev, "RAD", "per component");
}

std::optional<PlanMotionOptions> parseOptions(int argc, char** argv) {
  PlanMotionOptions options;
  ControlGains& gains = options.planner.rehearsal.controller.motion_gains;
  CommandLine line(kIntroduction);
  line.beginGroup("Files");
  line.addRequiredInput(
      "actuator", options.actuator_path, "YAML", "actuator description, nominal or calibrated");
  line.addRequiredOutput("output", options.output_path, "YAML", "plan to write");
  line.addForce(options.overwrite);
  line.addInput("dimensions", options.dimensions_path, "YAML", "of the rotor, for its inertia");
  addMotionOptions(line, options.planner);
  addChoiceOptions(line, options);
  addSensorOptions(line, options.planner);
  line.beginGroup("Controller, as motion_gains in orientation_controller.yaml");
  line.add("proportional", gains.proportional, "1/S2", "gain");
  line.add("derivative", gains.derivative, "1/S", "gain");
  if (!line.parse(argc, argv, std::cout)) {
    return std::nullopt;
  }
  return options;
}

void writePlan(PlanMotionOptions& options) {
  requireNewFile(options.output_path, options.overwrite);
  const CalibratedDescription description = loadDescription(options.actuator_path);
  const Actuator& actuator = description.actuator;
  options.planner.model_error = options.model_error.value_or(likelyModelError(description));
  if (!actuator.hasTorqueModel()) {
    throw ConfigError(options.actuator_path + " has no poles, coils or torque curve to move by.");
  }
  const ActuatorDimensions dimensions =
      options.dimensions_path ? loadDimensions(*options.dimensions_path) : ActuatorDimensions{};
  RehearsalOptions& rehearsal = options.planner.rehearsal;
  rehearsal.controller.rotor.inertia = rotorInertia(actuator, dimensions);
  rehearsal.rotor = rehearsal.controller.rotor;
  // A load that the controller does not know of.
  rehearsal.rotor.unbalance = Eigen::Vector3d(0.003, -0.004, 0.002);
  rehearsal.joint_rate = options.planner.sensors.joint_rate;
  rehearsal.joint_noise = options.planner.sensors.joint_stddev;
  rehearsal.current_rate = options.planner.sensors.current_rate;
  const PlannedMotionResult result =
      planMotion(actuator, options.planner, [](const std::string& text) {
        std::printf("%s\n", text.c_str());
        std::fflush(stdout);
      });
  for (const Rehearsal& rehearsed : result.rehearsals) {
    std::printf(
        "Rehearsal: tilt up to %.3f rad, %.0f mrad from the reference at most, %.2f A of all coils "
        "in the mean, %.2f A at most, %.0f %% of the excitation.\n",
        rehearsed.largest_tilt,
        1e3 * rehearsed.largest_tracking_error,
        rehearsed.mean_total_current,
        rehearsed.largest_total_current,
        100.0 * rehearsed.mean_excitation_share);
  }
  std::printf(
      "Excitation %.3f A rms of each coil; worst expected standard deviation %.4f mrad (%s).\n",
      result.excitation,
      1e3 * result.worst_stddev,
      result.worst_parameter.c_str());
  constexpr double kCoarse = 1e-3;  // [rad] ten poses in a fixture tell four times as much
  if (result.worst_stddev > kCoarse) {
    std::printf(
        "That is coarse: a longer motion tells more, and so do larger limits of current and "
        "tilt.\n");
  }
  writeFileAtomically(options.output_path, renderMotionPlan(result.record), options.overwrite);
  std::printf("Plan: %s\n", options.output_path.c_str());
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("plan_motion", [&] {
    auto options = sac::parseOptions(argc, argv);
    if (options) {
      sac::writePlan(*options);
    }
    return sac::kToolSuccess;
  });
}
