#include "simulate_recording_options.hpp"

#include <array>
#include <filesystem>
#include <sstream>

#include <Eigen/Core>

#include "command_line.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

constexpr char kIntroduction[] =
    "Usage: simulate_recording --actuator A.yaml --output OUT.bag [options]\n"
    "\n"
    "Writes a rosbag of an emulated calibration session, as it would be recorded from the "
    "actuator\n"
    "that the description names, and the true parameters beside it. The seed decides everything\n"
    "random: the same command gives the same measurements.\n"
    "Exit status: 0 the recording is complete, 2 it is not (and the reason on the standard "
    "error).\n\n";

/// Options that need a translation before they enter the structs.
struct RawValues {
  std::optional<std::string> truth_out;
  std::uint64_t seed = 0;
  std::size_t main_coil = 0;
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

void addFileOptions(CommandLine& line, SimulateRecordingOptions& options, RawValues& raw) {
  line.beginGroup("Files");
  line.addRequiredInput(
      "actuator", options.actuator_path, "YAML", "actuator description (nominal)");
  line.addRequiredOutput("output", options.output_path, "BAG", "recording to write");
  line.add("truth-out",
           raw.truth_out,
           "YAML",
           "where the true parameters are written; without it OUT.truth.yaml beside OUT.bag");
  line.addInput("truth-in",
                options.truth_in_path,
                "YAML",
                "true parameters; without it they are drawn around the nominal ones");
  line.addForce(options.bag.overwrite);
  line.add("ns", options.bag.ns, "NAME", "namespace of the topics");
  line.add("compression", raw.compression, "none|lz4", "of the recording");
}

void addTruthOptions(CommandLine& line, SimulateRecordingOptions& options, RawValues& raw) {
  line.beginGroup("Truth: errors uniform within ± around the nominal parameters");
  ManufacturingErrors& errors = options.errors;
  line.add("seed", raw.seed, "N", "of everything random");
  line.add("offset-error", errors.joint_offset, "RAD", "of joint offsets");
  line.add("axis-error", errors.joint_axis, "RAD", "of joint axes");
  line.add("pole-error", errors.pole_angle, "RAD", "of pole angles");
  line.add("coil-error", errors.coil_angle, "RAD", "of coil angles");
  line.add("strength-error", errors.strength, "SHARE", "of the strength of poles and coils");
}

void addPlanOptions(CommandLine& line, SimulateRecordingOptions& options, RawValues& raw) {
  line.beginGroup("Session");
  SessionPlanOptions& plan = options.plan;
  line.addInput("plan",
                options.plan_path,
                "YAML",
                "session planned by plan_session; takes the place of all options below, "
                "except tracker-poses");
  line.add("joint-poses", plan.joint_poses, "N", "poses without current");
  line.add("main-coil", raw.main_coil, "J", "coil that identifies the poles; coils count from 1");
  line.add("main-coil-poses", plan.main_coil_poses, "N", "poses with the main coil excited");
  line.add("coil-poses", plan.coil_poses, "N", "poses with each other coil excited");
  line.add(
      "coils-per-dwell", plan.coils_per_dwell, "N", "most other coils excited in turn at one pose");
  line.add("validation-poses",
           plan.validation_poses,
           "N",
           "poses at the end with several coils excited at once");
  line.add("current", plan.current, "A", "of an excited coil");
  line.add("joint-tilt",
           plan.joint_tilt_share,
           "SHARE",
           "tilt of joint and validation poses, share of the workspace's limit");
  line.add("torque-tilt",
           plan.torque_tilt_share,
           "SHARE",
           "tilt of the other poses, share of the workspace's limit");
  line.add("tracker-poses",
           options.simulation.tracker.poses,
           "N",
           "poses with the tracker on, from the first; without it all");
}

void addSensorOptions(CommandLine& line, SimulateRecordingOptions& options, RawValues& raw) {
  line.beginGroup("Sensors and load");
  SimulationOptions& simulation = options.simulation;
  line.add("joint-rate", simulation.joint_sensor.stream.rate, "HZ", "of joint states");
  line.add("tracker-rate", simulation.tracker.stream.rate, "HZ", "of tracker poses");
  line.add("wrench-rate", simulation.wrench_sensor.stream.rate, "HZ", "of wrenches");
  line.add("current-rate", simulation.current_sensor.stream.rate, "HZ", "of coil currents");
  line.add("joint-noise", simulation.joint_sensor.noise, "RAD", "standard deviation");
  line.add("joint-quantisation",
           simulation.joint_sensor.quantisation,
           "RAD",
           "step of the joint sensors");
  line.add("orientation-noise",
           simulation.tracker.orientation_noise,
           "RAD",
           "uniform within ± per component");
  line.add("force-noise", simulation.wrench_sensor.force_noise, "N", "standard deviation");
  line.add("torque-noise", simulation.wrench_sensor.torque_noise, "NM", "standard deviation");
  line.add("current-noise", simulation.current_sensor.noise, "A", "standard deviation");
  line.add("current-quantisation",
           simulation.current_sensor.quantisation,
           "A",
           "step of the current sensors");
  line.add("force-bias", raw.force_bias, "X,Y,Z", "of the force/torque sensor [N]");
  line.add("torque-bias",
           raw.torque_bias,
           "X,Y,Z",
           "of the force/torque sensor [N m]; usual are 2.7e-3");
  line.add("unbalance",
           raw.unbalance,
           "X,Y,Z",
           "rotor weight times the position of its centre of gravity [N m]; usual are 5.5e-3");
  line.add("rotor-weight", simulation.load.weight, "N", "that the force/torque sensor feels");
}

void addDefectOptions(CommandLine& line, SimulateRecordingOptions& options, RawValues& raw) {
  line.beginGroup("Defects");
  line.add("jitter", raw.jitter, "S", "of stamps, uniform within ±");
  line.add("dropouts", raw.dropouts, "N", "spans of silence per stream");
  line.add("dropout-duration", raw.dropout_duration, "S", "of each");
  line.add("repeated-share", raw.repeated_share, "SHARE", "of measurements delivered twice");
  line.add(
      "nan-share", raw.nan_share, "SHARE", "of measurements with a value that is not a number");
  line.add(
      "glitches", raw.glitches, "N", "single orientations, and as many torques, that are far off");
  line.add("bad-dwells",
           options.simulation.tracker.bad_dwells,
           "N",
           "dwells throughout which the orientation is off");
  line.add("bad-dwell-error", options.simulation.tracker.bad_dwell_error, "RAD", "by this angle");
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
void requireNoOtherPlan(const CommandLine& line) {
  for (const char* option : {"joint-poses",
                             "main-coil",
                             "main-coil-poses",
                             "coil-poses",
                             "coils-per-dwell",
                             "validation-poses",
                             "current",
                             "joint-tilt",
                             "torque-tilt"}) {
    if (line.wasGiven(option)) {
      throw ConfigError("--" + std::string(option) + " has no meaning beside --plan.");
    }
  }
}

void apply(const RawValues& raw, SimulateRecordingOptions& options) {
  const std::optional<std::size_t> main_coil = indexOf(raw.main_coil);
  if (!main_coil) {
    throw ConfigError("--main-coil: coils count from 1.");
  }
  options.truth_path = raw.truth_out.value_or(besideRecording(options.output_path));
  options.plan.main_coil = *main_coil;
  options.simulation.seed = raw.seed;
  options.simulation.wrench_sensor.force_bias = parseVector("force-bias", raw.force_bias);
  options.simulation.wrench_sensor.torque_bias = parseVector("torque-bias", raw.torque_bias);
  options.simulation.load.unbalance = parseVector("unbalance", raw.unbalance);
  applyStreamDefects(raw, options.simulation);
  options.bag.compression =
      choose<BagCompression>("compression",
                             raw.compression,
                             {{"none", BagCompression::kNone}, {"lz4", BagCompression::kLz4}});
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

  CommandLine line(kIntroduction);
  addFileOptions(line, options, raw);
  addTruthOptions(line, options, raw);
  addPlanOptions(line, options, raw);
  addSensorOptions(line, options, raw);
  addDefectOptions(line, options, raw);
  if (!line.parse(argc, argv, out)) {
    return std::nullopt;
  }
  if (options.plan_path) {
    requireNoOtherPlan(line);
  }
  apply(raw, options);
  line.requireSeparate("output", options.output_path + ".active");
  line.requireSeparate("truth-out", options.truth_path);
  return options;
}

}  // namespace sac
