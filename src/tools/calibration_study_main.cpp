#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <boost/crc.hpp>

#include "command_line.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/version.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/planning/session_plan_file.hpp"
#include "spherical_actuator_calibration/study/study_file.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

constexpr char kIntroduction[] =
    "Usage: calibration_study --actuator A.yaml --output STUDY.yaml [options]\n"
    "       calibration_study --merge --output STUDY.yaml SHARD.yaml...\n"
    "\n"
    "Calibrates many emulated actuators and compares the errors with the Cramer-Rao bound and "
    "with\n"
    "the stated uncertainties. Trials split into shards, whose merge is the whole study exactly:\n"
    "  parallel calibration_study --actuator A.yaml --shard {}/4 --output {}.yaml ::: 1 2 3 4\n"
    "  calibration_study --merge --output study.yaml 1.yaml 2.yaml 3.yaml 4.yaml\n"
    "Exit status: 0 the study is written, 2 it is not (and the reason on the standard error).\n\n";

/// Part i of n, counted from 1.
struct Shard {
  std::uint64_t index = 1;
  std::uint64_t count = 1;
};

struct Options {
  std::optional<std::string> actuator_path;
  std::optional<std::string> config_path;
  std::string output_path;
  std::optional<std::string> plan_path;
  std::vector<std::string> shard_paths;
  bool merge = false;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
  std::uint64_t trials = 300;
  std::uint64_t seed = 1;
  std::uint64_t plan_seed = 1;
  std::string shard_text = "1/1";
  std::string tracker = "first";
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  SessionPlanOptions plan;
  SampleNoise noise;
  ManufacturingErrors errors;
};

void addTrialOptions(CommandLine& line, Options& options) {
  line.beginGroup("Options");
  line.addInput("actuator", options.actuator_path, "YAML", "actuator description (nominal)");
  line.addInput("config", options.config_path, "YAML", "as for calibrate_bag");
  line.addRequiredOutput("output", options.output_path, "YAML", "study to write");
  line.addForce(options.overwrite);
  line.addSwitch("merge", options.merge, "join the shards that are given");
  line.add("trials", options.trials, "N", "of the whole study");
  line.add("seed", options.seed, "N", "of the first trial; each further one counts up");
  line.add("shard", options.shard_text, "I/N", "do only part I of N");
  line.add("threads", options.threads, "N", "to run trials on");
}

void addSessionOptions(CommandLine& line, Options& options) {
  line.addInput("plan",
                options.plan_path,
                "YAML",
                "session planned by plan_session, in the place of the poses and the current below");
  line.add("plan-seed", options.plan_seed, "N", "of the poses, the same in all trials");
  line.add("joint-poses", options.plan.joint_poses, "N", "poses without current");
  line.add("main-coil-poses", options.plan.main_coil_poses, "N", "poses with coil 1 excited");
  line.add("coil-poses", options.plan.coil_poses, "N", "poses with each other coil excited");
  line.add("joint-tilt", options.plan.joint_tilt_share, "SHARE", "of the tilt limit");
  line.add("torque-tilt", options.plan.torque_tilt_share, "SHARE", "of the tilt limit");
  line.add("current", options.plan.current, "A", "of an excited coil");
  line.add("tracker", options.tracker, "first|every", "at poses without current, or at all");
}

void addErrorOptions(CommandLine& line, Options& options) {
  line.add("orientation-noise", options.noise.orientation, "RAD", "standard deviation");
  line.add("torque-noise", options.noise.torque, "NM", "standard deviation");
  line.add("joint-noise", options.noise.joint, "RAD", "standard deviation");
  line.add("offset-error", options.errors.joint_offset, "RAD", "half width of made offsets");
  line.add("axis-error", options.errors.joint_axis, "RAD", "the same of joint axes");
  line.add("pole-error", options.errors.pole_angle, "RAD", "the same of pole angles");
  line.add("coil-error", options.errors.coil_angle, "RAD", "the same of coil angles");
}

std::optional<Options> parseOptions(int argc, char** argv) {
  Options options;
  options.plan.validation_poses = 0;
  CommandLine line(kIntroduction);
  addTrialOptions(line, options);
  addSessionOptions(line, options);
  addErrorOptions(line, options);
  line.addInputs(options.shard_paths, "SHARD");
  if (!line.parse(argc, argv, std::cout)) {
    return std::nullopt;
  }
  if (!options.merge && !options.actuator_path) {
    throw ConfigError("--actuator is needed; --help tells what it is.");
  }
  if (options.merge == options.shard_paths.empty()) {
    throw ConfigError("--merge takes the files of the shards, and nothing else does; see --help.");
  }
  return options;
}

Shard parseShard(const std::string& text) {
  Shard shard;
  char rest = 0;
  unsigned long index = 0;
  unsigned long count = 0;
  if (std::sscanf(text.c_str(), "%lu/%lu%c", &index, &count, &rest) != 2 || index < 1 ||
      index > count) {
    throw ConfigError("--shard: " + text + " is not I/N with 1 <= I <= N.");
  }
  shard.index = index;
  shard.count = count;
  return shard;
}

/// Tells contents apart wherever their files are.
std::string checksumOf(const std::optional<std::string>& path) {
  if (!path) {
    return "none";
  }
  const std::string content = readInputFile(*path);
  boost::crc_32_type checksum;
  checksum.process_bytes(content.data(), content.size());
  return format("crc32:%08x", checksum.checksum());
}

/// What the trials depend on.
std::vector<std::pair<std::string, std::string>> settingsOf(const Options& options,
                                                            const Actuator& nominal) {
  return {{"software", packageVersion()},
          {"actuator", nominal.name},
          {"actuator file", checksumOf(options.actuator_path)},
          {"configuration", checksumOf(options.config_path)},
          {"plan file", checksumOf(options.plan_path)},
          {"tracker", options.tracker},
          {"plan", options.plan_path.value_or("random")},
          {"plan seed", std::to_string(options.plan_seed)},
          {"joint poses", std::to_string(options.plan.joint_poses)},
          {"poses with coil 1", std::to_string(options.plan.main_coil_poses)},
          {"poses with each other coil", std::to_string(options.plan.coil_poses)},
          {"tilt of joint poses [share]", format("%g", options.plan.joint_tilt_share)},
          {"tilt of torque poses [share]", format("%g", options.plan.torque_tilt_share)},
          {"current [A]", format("%g", options.plan.current)},
          {"orientation noise [rad]", format("%g", options.noise.orientation)},
          {"torque noise [N·m]", format("%g", options.noise.torque)},
          {"joint noise [rad]", format("%g", options.noise.joint)},
          {"offset error [rad]", format("%g", options.errors.joint_offset)},
          {"axis error [rad]", format("%g", options.errors.joint_axis)},
          {"pole error [rad]", format("%g", options.errors.pole_angle)},
          {"coil error [rad]", format("%g", options.errors.coil_angle)}};
}

StudyRecord run(const Options& options) {
  const Shard shard = parseShard(options.shard_text);
  StudyOptions study;
  study.nominal = loadActuator(*options.actuator_path);
  study.plan = options.plan_path ? loadPlannedSession(*options.plan_path, study.nominal)
                                 : planSession(study.nominal, options.plan, options.plan_seed);
  study.tracker = choose<TrackerUse>(
      "tracker",
      options.tracker,
      {{"first", TrackerUse::kPosesWithoutCurrent}, {"every", TrackerUse::kEveryPose}});
  study.noise = options.noise;
  study.errors = options.errors;
  if (options.config_path) {
    study.estimation = loadCalibrationConfig(*options.config_path).estimation;
  }
  StudyRecord record;
  record.settings = settingsOf(options, study.nominal);
  record.first_seed = options.seed;
  record.trial_count = options.trials;
  record.trials = runTrials(study,
                            options.seed + shard.index - 1,
                            options.seed + options.trials,
                            shard.count,
                            options.threads,
                            terminalProgress("trials"));
  return record;
}

StudyRecord merge(const Options& options) {
  std::vector<StudyRecord> shards;
  shards.reserve(options.shard_paths.size());
  for (const std::string& path : options.shard_paths) {
    shards.push_back(loadStudy(path));
  }
  return mergeStudies(shards, options.shard_paths);
}

void print(const char* name, const StageSummary& stage) {
  std::printf("%s: %zu of %zu trials converged\n", name, stage.converged, stage.trials);
  const auto line = [](const char* group, const StudyErrors& errors) {
    std::printf("  %-12s error %8.4f mrad, bound %8.4f mrad, ratio %6.3f, coverage %5.1f %%\n",
                group,
                1e3 * errors.rms_error,
                1e3 * errors.rms_bound,
                errors.ratio(),
                100.0 * errors.coverage);
  };
  if (stage.converged == 0) {
    return;
  }
  for (std::size_t g = 0; g < kParameterGroups; ++g) {
    if (stage.groups[g].rms_bound > 0.0) {
      line(groupName(static_cast<ParameterGroup>(g)), stage.groups[g]);
    }
  }
  line("all", stage.all);
}

void study(const Options& options) {
  requireNewFile(options.output_path, options.overwrite);
  const StudyRecord record = options.merge ? merge(options) : run(options);
  print("sequence", summarizeSequence(record.trials));
  print("refinement", summarizeRefinement(record.trials));
  writeFileAtomically(options.output_path, renderStudy(record), options.overwrite);
  std::printf("Study: %s\n", options.output_path.c_str());
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("calibration_study", [&] {
    const auto options = sac::parseOptions(argc, argv);
    if (options) {
      sac::study(*options);
    }
    return sac::kToolSuccess;
  });
}
