#include "plan_session_options.hpp"

#include <ostream>
#include <sstream>

#include <boost/program_options.hpp>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"

namespace sac {
namespace {

namespace po = boost::program_options;

constexpr char kIntroduction[] =
    "Usage: plan_session --actuator A.yaml --output PLAN.yaml [options] [BAG...]\n"
    "\n"
    "Plans the poses of a calibration session, and the coils to excite at each, that tell most "
    "about\n"
    "the parameters. The plan holds the standard deviation that each parameter will reach.\n"
    "Recordings and samples that are given count as measured already. simulate_recording --plan\n"
    "carries a plan out. A calibrated description plans from its values.\n"
    "Exit status: 0 the plan is written, 2 it is not (and the reason on the standard error).\n";

/// Options that need a translation before they enter the structs.
struct RawValues {
  std::string config;
  std::string samples;
  std::string cycle = "refine";
  std::string tracker = "on";
  std::string criterion = "worst";
  double tilt = 0.0;
  double joint_stddev = 0.0;
};

/// An option that is stored in `target` and has the target's present value as its default.
template <typename Value>
po::typed_value<Value>* stored(Value& target, const char* unit) {
  std::ostringstream text;
  text << target;
  return po::value<Value>(&target)->default_value(target, text.str())->value_name(unit);
}

po::options_description fileOptions(PlanSessionOptions& options, RawValues& raw) {
  po::options_description group("Files");
  auto add = group.add_options();
  add("help,h", "print this help and exit");
  add("actuator",
      po::value(&options.actuator_path)->value_name("YAML"),
      "actuator description, nominal or calibrated; needed");
  add("output", po::value(&options.output_path)->value_name("YAML"), "plan to write; needed");
  add("force", "replace the output if it exists");
  add("config", po::value(&raw.config)->value_name("YAML"), "as for calibrate_bag");
  add("samples", po::value(&raw.samples)->value_name("YAML"), "samples measured already");
  add("ns", stored(options.ns, "NAME"), "namespace of the topics of recordings");
  return group;
}

po::options_description planOptions(PosePlanOptions& plan, RawValues& raw) {
  po::options_description group("Plan");
  auto add = group.add_options();
  add("cycle", stored(raw.cycle, "CYCLE"), "to plan for: refine, joint, poles:J or coil:J");
  add("poses", stored(plan.max_poses, "N"), "at most");
  add("torques-per-pose", stored(plan.coils_per_pose, "N"), "coils excited in turn, at most");
  add("wanted-stddev",
      stored(plan.wanted_stddev, "RAD"),
      "stop as soon as every parameter is expected to be this good; 0: use all poses");
  add("tilt",
      po::value(&raw.tilt)->value_name("RAD"),
      "of joints 1 and 2 within ±; without it the workspace's limit");
  add("spin-minimum", stored(plan.spin_minimum, "RAD"), "of joint 3");
  add("spin-maximum", stored(plan.spin_maximum, "RAD"), "of joint 3");
  add("spacing", stored(plan.minimum_spacing, "RAD"), "between two poses, at least");
  add("current", stored(plan.current, "A"), "of an excited coil");
  add("tracker", stored(raw.tracker, "on|off"), "at the poses of a refinement");
  add("criterion",
      stored(raw.criterion, "worst|information"),
      "smallest worst standard deviation, or largest information (D-optimal)");
  add("candidates", stored(plan.candidates, "N"), "random poses to choose from");
  add("seed", stored(plan.seed, "N"), "of these poses");
  return group;
}

po::options_description sensorOptions(PosePlanOptions& plan, RawValues& raw) {
  po::options_description group("Standard deviations of the mean values that samples will be");
  auto add = group.add_options();
  add("orientation-stddev", stored(plan.orientation_stddev, "RAD"), "per component");
  add("torque-stddev", stored(plan.torque_stddev, "NM"), "per component");
  add("joint-stddev", stored(raw.joint_stddev, "RAD"), "per joint");
  return group;
}

CycleRequest parseCycle(const std::string& text) {
  const std::vector<CycleRequest> cycles = parseCycles(text);
  // "coils" stands for a coil without number.
  if (cycles.size() != 1 || (cycles.front().cycle == Cycle::kCoil && !cycles.front().coil)) {
    throw ConfigError("--cycle: \"" + text + "\" is not one cycle; see --help.");
  }
  return cycles.front();
}

/// True for the first word, false for the second.
bool parseWord(const char* option, const std::string& text, const char* yes, const char* no) {
  if (text != yes && text != no) {
    throw ConfigError("--" + std::string(option) + ": \"" + text + "\" is neither " + yes +
                      " nor " + no + ".");
  }
  return text == yes;
}

void apply(const RawValues& raw, const po::variables_map& given, PlanSessionOptions& options) {
  for (const char* needed : {"actuator", "output"}) {
    if (given.count(needed) == 0) {
      throw ConfigError("--" + std::string(needed) + " is needed; see --help.");
    }
  }
  if (given.count("config") != 0) {
    options.config_path = raw.config;
  }
  if (given.count("samples") != 0) {
    options.samples_path = raw.samples;
  }
  if (given.count("tilt") != 0) {
    options.plan.tilt_limit = raw.tilt;
  }
  if (given.count("force") != 0) {
    options.overwrite = OverwritePolicy::kReplace;
  }
  options.cycle = parseCycle(raw.cycle);
  options.plan.tracker_on = parseWord("tracker", raw.tracker, "on", "off");
  options.plan.criterion = parseWord("criterion", raw.criterion, "worst", "information")
                               ? PlanCriterion::kWorstStddev
                               : PlanCriterion::kInformation;
  options.plan.joint_stddev.setConstant(raw.joint_stddev);
}

}  // namespace

std::optional<PlanSessionOptions> parsePlanSessionOptions(int argc,
                                                          const char* const* argv,
                                                          std::ostream& out) {
  PlanSessionOptions options;
  RawValues raw;
  po::options_description known;
  known.add(fileOptions(options, raw))
      .add(planOptions(options.plan, raw))
      .add(sensorOptions(options.plan, raw));
  po::options_description all = known;
  all.add_options()("bags", po::value(&options.bags));
  po::positional_options_description positional;
  positional.add("bags", -1);
  po::variables_map given;
  try {
    po::store(po::command_line_parser(argc, argv).options(all).positional(positional).run(), given);
    po::notify(given);
  } catch (const po::error& error) {
    throw ConfigError(std::string(error.what()) + "; see --help.");
  }
  if (given.count("help") != 0) {
    out << kIntroduction << known << "\n";
    return std::nullopt;
  }
  apply(raw, given, options);
  return options;
}

}  // namespace sac
