#include "plan_session_options.hpp"

#include "command_line.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

namespace sac {
namespace {

constexpr char kIntroduction[] =
    "Usage: plan_session --actuator A.yaml --output PLAN.yaml [options] [BAG...]\n"
    "\n"
    "Plans the poses of a calibration session, and the coils to excite at each, that tell most\n"
    "about the parameters. The plan holds the standard deviation that each parameter will reach,\n"
    "and says how near it comes to what any plan of as many poses and torques could reach.\n"
    "Recordings and samples that are given count as measured already. simulate_recording --plan\n"
    "carries a plan out. A calibrated description plans from its values.\n"
    "Exit status: 0 the plan is written, 2 it is not (and the reason on the standard error).\n\n";

/// Options that need a translation before they enter the structs.
struct RawValues {
  std::string cycle = "refine";
  std::string tracker = "on";
  std::string criterion = "worst";
  std::string patterns = "weighing";
  double joint_stddev = 0.0;
};

void addFileOptions(CommandLine& line, PlanSessionOptions& options) {
  line.beginGroup("Files");
  line.addRequiredInput(
      "actuator", options.actuator_path, "YAML", "actuator description, nominal or calibrated");
  line.addRequiredOutput("output", options.output_path, "YAML", "plan to write");
  line.addForce(options.overwrite);
  line.addInput("config", options.config_path, "YAML", "as for calibrate_bag");
  line.addInput("samples", options.samples_path, "YAML", "samples measured already");
  line.add("ns", options.ns, "NAME", "namespace of the topics of recordings");
  line.addInputs(options.bags, "BAG");
}

void addPlanOptions(CommandLine& line, PosePlanOptions& plan, double& time_budget, RawValues& raw) {
  line.beginGroup("Plan");
  line.add("cycle", raw.cycle, "CYCLE", "to plan for: refine, joint, poles:J or coil:J");
  line.add("poses", plan.max_poses, "N", "at most");
  line.add("torques-per-pose", plan.coils_per_pose, "N", "coils or patterns in turn, at most");
  line.add("patterns",
           raw.patterns,
           "single|weighing",
           "one coil at a time, or several at once with chosen signs (refine only)");
  line.add("wanted-stddev",
           plan.wanted_stddev,
           "RAD",
           "stop as soon as every parameter is expected to be this good; 0: use all poses");
  line.add("tilt",
           plan.tilt_limit,
           "RAD",
           "of joints 1 and 2 within ±; without it the workspace's limit");
  line.add("spin-minimum", plan.spin_minimum, "RAD", "of joint 3");
  line.add("spin-maximum", plan.spin_maximum, "RAD", "of joint 3");
  line.add("spacing", plan.minimum_spacing, "RAD", "between two poses, at least");
  line.add("current", plan.current, "A", "of an excited coil");
  line.add("total-current",
           plan.total_current,
           "A",
           "sum of all |currents| of a pattern, at most, as the amplifier's limit");
  line.add("tracker", raw.tracker, "on|off", "at the poses of a refinement");
  line.add("criterion",
           raw.criterion,
           "worst|information",
           "smallest worst standard deviation, or largest information (D-optimal)");
  line.add("time-budget",
           time_budget,
           "S",
           "write the best plan so far after this time; 0: plan to the end");
  line.add("candidates", plan.candidates, "N", "random poses to choose from");
  line.add("seed", plan.seed, "N", "of these poses");
}

void addSensorOptions(CommandLine& line, PosePlanOptions& plan, RawValues& raw) {
  line.beginGroup("Standard deviations of the mean values that samples will be");
  line.add("orientation-stddev", plan.orientation_stddev, "RAD", "per component");
  line.add("torque-stddev", plan.torque_stddev, "NM", "per component");
  line.add("joint-stddev", raw.joint_stddev, "RAD", "per joint");
}

CycleRequest parseCycle(const std::string& text) {
  const std::vector<CycleRequest> cycles = parseCycles(text);
  // "coils" stands for a coil without number.
  if (cycles.size() != 1 || (cycles.front().cycle == Cycle::kCoil && !cycles.front().coil)) {
    throw ConfigError("--cycle: \"" + text + "\" is not one cycle; see --help.");
  }
  return cycles.front();
}

}  // namespace

std::optional<PlanSessionOptions> parsePlanSessionOptions(int argc,
                                                          const char* const* argv,
                                                          std::ostream& out) {
  PlanSessionOptions options;
  RawValues raw;
  CommandLine line(kIntroduction);
  addFileOptions(line, options);
  addPlanOptions(line, options.plan, options.time_budget, raw);
  addSensorOptions(line, options.plan, raw);
  if (!line.parse(argc, argv, out)) {
    return std::nullopt;
  }
  options.cycle = parseCycle(raw.cycle);
  options.plan.tracker_on = choose<bool>("tracker", raw.tracker, {{"on", true}, {"off", false}});
  options.plan.patterns = choose<PlanPatterns>(
      "patterns",
      raw.patterns,
      {{"single", PlanPatterns::kSingle}, {"weighing", PlanPatterns::kWeighing}});
  requireInRange("--time-budget", options.time_budget, ValueRange::nonNegative("s"));
  options.plan.criterion = choose<PlanCriterion>(
      "criterion",
      raw.criterion,
      {{"worst", PlanCriterion::kWorstStddev}, {"information", PlanCriterion::kInformation}});
  options.plan.joint_stddev.setConstant(raw.joint_stddev);
  return options;
}

}  // namespace sac
