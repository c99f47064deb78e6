#include "simulate_recording_options.hpp"

#include <array>
#include <filesystem>
#include <ostream>
#include <sstream>

#include <Eigen/Core>

#include <boost/program_options.hpp>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;

constexpr char kIntroduction[] =
    "Usage: simulate_recording --actuator A.yaml --output OUT.bag [options]\n"
    "\n"
    "Writes a rosbag of an emulated calibration session, as it would be recorded from the "
    "actuator\n"
    "that the description names, and the true parameters beside it. The seed decides everything\n"
    "random: the same command gives the same measurements.\n"
    "Exit status: 0 the recording is complete, 2 it is not (and the reason on the standard "
    "error).\n";

/// Options that need a translation before they enter the structs.
struct RawValues {
  std::string truth_in;
  std::string plan_path;
  std::uint64_t seed = 0;
  std::size_t main_coil = 0;
  std::size_t tracker_poses = 0;
  std::string force_bias;
  std::string torque_bias;
  std::string unbalance;
  std::string compression;
  // The same for every stream.
  double jitter = 0.0;
  std::size_t dropouts = 0;
  double dropout_duration = 0.0;
  double repeated_share = 0.0;
  double nan_share = 0.0;
  std::size_t glitches = 0;
};

/// An option that is stored in `target` and has the target's present value as its default.
template <typename Value>
po::typed_value<Value>* stored(Value& target, const char* name) {
  return po::value<Value>(&target)->default_value(target)->value_name(name);
}

/// An option that fills in a number of a struct; its default is shown with few digits.
po::typed_value<double>* number(double& target, const char* unit) {
  std::ostringstream text;
  text << target;
  return po::value<double>(&target)->default_value(target, text.str())->value_name(unit);
}

po::options_description fileOptions(SimulateRecordingOptions& options, RawValues& raw) {
  po::options_description group("Files");
  group.add_options()("help,h", "print this help and exit");
  group.add_options()("actuator",
                      po::value(&options.actuator_path)->value_name("YAML"),
                      "actuator description (nominal); needed");
  group.add_options()(
      "output", po::value(&options.output_path)->value_name("BAG"), "recording to write; needed");
  group.add_options()(
      "truth-out",
      po::value(&options.truth_path)->value_name("YAML"),
      "where the true parameters are written; without it OUT.truth.yaml beside OUT.bag");
  group.add_options()("truth-in",
                      po::value(&raw.truth_in)->value_name("YAML"),
                      "true parameters; without it they are drawn around the nominal ones");
  group.add_options()("force", "replace files that exist");
  group.add_options()("ns", stored(options.bag.ns, "NAME"), "namespace of the topics");
  group.add_options()("compression", stored(raw.compression, "none|lz4"), "of the recording");
  return group;
}

po::options_description truthOptions(SimulateRecordingOptions& options, RawValues& raw) {
  po::options_description group("Truth: errors uniform within ± around the nominal parameters");
  ManufacturingErrors& errors = options.errors;
  group.add_options()("seed", stored(raw.seed, "N"), "of everything random");
  group.add_options()("offset-error", number(errors.joint_offset, "RAD"), "of joint offsets");
  group.add_options()("axis-error", number(errors.joint_axis, "RAD"), "of joint axes");
  group.add_options()("pole-error", number(errors.pole_angle, "RAD"), "of pole angles");
  group.add_options()("coil-error", number(errors.coil_angle, "RAD"), "of coil angles");
  group.add_options()(
      "strength-error", number(errors.strength, "SHARE"), "of the strength of poles and coils");
  return group;
}

po::options_description planOptions(SimulateRecordingOptions& options, RawValues& raw) {
  po::options_description group("Session");
  SessionPlanOptions& plan = options.plan;
  group.add_options()("plan",
                      po::value(&raw.plan_path)->value_name("YAML"),
                      "session planned by plan_session; takes the place of all options below, "
                      "except tracker-poses");
  group.add_options()("joint-poses", stored(plan.joint_poses, "N"), "poses without current");
  group.add_options()("main-coil",
                      stored(raw.main_coil, "J"),
                      "coil that identifies the poles; coils count from 1");
  group.add_options()(
      "main-coil-poses", stored(plan.main_coil_poses, "N"), "poses with the main coil excited");
  group.add_options()(
      "coil-poses", stored(plan.coil_poses, "N"), "poses with each other coil excited");
  group.add_options()("coils-per-dwell",
                      stored(plan.coils_per_dwell, "N"),
                      "most other coils excited in turn at one pose");
  group.add_options()("validation-poses",
                      stored(plan.validation_poses, "N"),
                      "poses at the end with several coils excited at once");
  group.add_options()("current", number(plan.current, "A"), "of an excited coil");
  group.add_options()("joint-tilt",
                      number(plan.joint_tilt_share, "SHARE"),
                      "tilt of joint and validation poses, share of the workspace's limit");
  group.add_options()("torque-tilt",
                      number(plan.torque_tilt_share, "SHARE"),
                      "tilt of the other poses, share of the workspace's limit");
  group.add_options()("tracker-poses",
                      po::value(&raw.tracker_poses)->value_name("N"),
                      "poses with the tracker on, from the first; without it all");
  return group;
}

po::options_description sensorOptions(SimulateRecordingOptions& options, RawValues& raw) {
  po::options_description group("Sensors and load");
  SimulationOptions& simulation = options.simulation;
  group.add_options()(
      "joint-rate", number(simulation.joint_sensor.stream.rate, "HZ"), "of joint states");
  group.add_options()(
      "tracker-rate", number(simulation.tracker.stream.rate, "HZ"), "of tracker poses");
  group.add_options()(
      "wrench-rate", number(simulation.wrench_sensor.stream.rate, "HZ"), "of wrenches");
  group.add_options()(
      "current-rate", number(simulation.current_sensor.stream.rate, "HZ"), "of coil currents");
  group.add_options()(
      "joint-noise", number(simulation.joint_sensor.noise, "RAD"), "standard deviation");
  group.add_options()("joint-quantisation",
                      number(simulation.joint_sensor.quantisation, "RAD"),
                      "step of the joint sensors");
  group.add_options()("orientation-noise",
                      number(simulation.tracker.orientation_noise, "RAD"),
                      "uniform within ± per component");
  group.add_options()(
      "force-noise", number(simulation.wrench_sensor.force_noise, "N"), "standard deviation");
  group.add_options()(
      "torque-noise", number(simulation.wrench_sensor.torque_noise, "NM"), "standard deviation");
  group.add_options()(
      "current-noise", number(simulation.current_sensor.noise, "A"), "standard deviation");
  group.add_options()("current-quantisation",
                      number(simulation.current_sensor.quantisation, "A"),
                      "step of the current sensors");
  group.add_options()(
      "force-bias", stored(raw.force_bias, "X,Y,Z"), "of the force/torque sensor [N]");
  group.add_options()("torque-bias",
                      stored(raw.torque_bias, "X,Y,Z"),
                      "of the force/torque sensor [N m]; usual are 2.7e-3");
  group.add_options()(
      "unbalance",
      stored(raw.unbalance, "X,Y,Z"),
      "rotor weight times the position of its centre of gravity [N m]; usual are 5.5e-3");
  group.add_options()(
      "rotor-weight", number(simulation.load.weight, "N"), "that the force/torque sensor feels");
  return group;
}

po::options_description defectOptions(SimulateRecordingOptions& options, RawValues& raw) {
  po::options_description group("Defects");
  group.add_options()("jitter", number(raw.jitter, "S"), "of stamps, uniform within ±");
  group.add_options()("dropouts", stored(raw.dropouts, "N"), "spans of silence per stream");
  group.add_options()("dropout-duration", number(raw.dropout_duration, "S"), "of each");
  group.add_options()(
      "repeated-share", number(raw.repeated_share, "SHARE"), "of measurements delivered twice");
  group.add_options()("nan-share",
                      number(raw.nan_share, "SHARE"),
                      "of measurements with a value that is not a number");
  group.add_options()("glitches",
                      stored(raw.glitches, "N"),
                      "single orientations, and as many torques, that are far off");
  group.add_options()("bad-dwells",
                      stored(options.simulation.tracker.bad_dwells, "N"),
                      "dwells throughout which the orientation is off");
  group.add_options()("bad-dwell-error",
                      number(options.simulation.tracker.bad_dwell_error, "RAD"),
                      "by this angle");
  return group;
}

Eigen::Vector3d parseVector(const std::string& option, const std::string& text) {
  std::istringstream input(text);
  Eigen::Vector3d vector;
  std::array<char, 2> commas{};
  input >> vector[0] >> commas[0] >> vector[1] >> commas[1] >> vector[2];
  std::string rest;
  if (!input || commas != std::array<char, 2>{',', ','} || input >> rest) {
    throw ConfigError("--" + option + ": \"" + text + "\" is not of the form X,Y,Z.");
  }
  return vector;
}

BagCompression parseCompression(const std::string& word) {
  if (word == "lz4") {
    return BagCompression::kLz4;
  }
  if (word == "none") {
    return BagCompression::kNone;
  }
  throw ConfigError("--compression: \"" + word + "\" is neither none nor lz4.");
}

/// "session.bag" → "session.truth.yaml".
std::string besideRecording(const std::string& output_path) {
  return fs::path(output_path).replace_extension(".truth.yaml").string();
}

void applyStreamDefects(const RawValues& raw, SimulationOptions& simulation) {
  for (StreamOptions* stream : {&simulation.joint_sensor.stream,
                                &simulation.tracker.stream,
                                &simulation.wrench_sensor.stream,
                                &simulation.current_sensor.stream}) {
    stream->jitter = raw.jitter;
    stream->dropouts = raw.dropouts;
    stream->dropout_duration = raw.dropout_duration;
    stream->repeated_share = raw.repeated_share;
    stream->nan_share = raw.nan_share;
  }
  simulation.tracker.stream.glitches = raw.glitches;
  simulation.wrench_sensor.stream.glitches = raw.glitches;
}

/// A session that is planned already has no room for other wishes.
void requireNoOtherPlan(const po::variables_map& given) {
  for (const char* option : {"joint-poses",
                             "main-coil",
                             "main-coil-poses",
                             "coil-poses",
                             "coils-per-dwell",
                             "validation-poses",
                             "current",
                             "joint-tilt",
                             "torque-tilt"}) {
    if (!given[option].defaulted()) {
      throw ConfigError("--" + std::string(option) + " has no meaning beside --plan.");
    }
  }
}

void apply(const RawValues& raw,
           const po::variables_map& given,
           SimulateRecordingOptions& options) {
  for (const char* needed : {"actuator", "output"}) {
    if (given.count(needed) == 0) {
      throw ConfigError("--" + std::string(needed) + " is needed; see --help.");
    }
  }
  if (raw.main_coil == 0) {
    throw ConfigError("--main-coil: coils count from 1.");
  }
  if (given.count("truth-in") != 0) {
    options.truth_in_path = raw.truth_in;
  }
  if (given.count("plan") != 0) {
    requireNoOtherPlan(given);
    options.plan_path = raw.plan_path;
  }
  if (given.count("truth-out") == 0) {
    options.truth_path = besideRecording(options.output_path);
  }
  if (given.count("tracker-poses") != 0) {
    options.simulation.tracker.poses = raw.tracker_poses;
  }
  options.plan.main_coil = raw.main_coil - 1;
  options.simulation.seed = raw.seed;
  options.simulation.wrench_sensor.force_bias = parseVector("force-bias", raw.force_bias);
  options.simulation.wrench_sensor.torque_bias = parseVector("torque-bias", raw.torque_bias);
  options.simulation.load.unbalance = parseVector("unbalance", raw.unbalance);
  applyStreamDefects(raw, options.simulation);
  options.bag.compression = parseCompression(raw.compression);
  options.bag.overwrite =
      given.count("force") != 0 ? OverwritePolicy::kReplace : OverwritePolicy::kRefuse;
  options.bag.registration = options.simulation.registration;
  options.bag.begin = options.simulation.begin;
}

}  // namespace

std::optional<SimulateRecordingOptions> parseSimulateRecordingOptions(int argc,
                                                                      const char* const* argv,
                                                                      std::ostream& out) {
  SimulateRecordingOptions options;
  RawValues raw;
  raw.seed = options.simulation.seed;
  raw.main_coil = numberOf(options.plan.main_coil);
  raw.force_bias = raw.torque_bias = raw.unbalance = "0,0,0";
  raw.compression = "lz4";
  raw.dropout_duration = StreamOptions{}.dropout_duration;

  po::options_description all;
  all.add(fileOptions(options, raw))
      .add(truthOptions(options, raw))
      .add(planOptions(options, raw))
      .add(sensorOptions(options, raw))
      .add(defectOptions(options, raw));
  po::variables_map given;
  try {
    po::store(po::command_line_parser(argc, argv).options(all).positional({}).run(), given);
    po::notify(given);
  } catch (const po::error& error) {
    throw ConfigError(std::string(error.what()) + "; see --help.");
  }
  if (given.count("help") != 0) {
    out << kIntroduction << all << "\n";
    return std::nullopt;
  }
  apply(raw, given, options);
  return options;
}

}  // namespace sac
