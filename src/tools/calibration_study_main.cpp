#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <boost/program_options.hpp>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/planning/session_plan_file.hpp"
#include "spherical_actuator_calibration/study/study_file.hpp"
#include "tool_main.hpp"

#include <unistd.h>

namespace sac {
namespace {

namespace po = boost::program_options;

constexpr char kIntroduction[] =
    "Usage: calibration_study --actuator A.yaml --output STUDY.yaml [options]\n"
    "       calibration_study --merge --output STUDY.yaml SHARD.yaml...\n"
    "\n"
    "Calibrates many emulated actuators and compares the errors with the Cramer-Rao bound and "
    "with\n"
    "the stated uncertainties. Trials split into shards, whose merge is the whole study exactly:\n"
    "  parallel calibration_study --actuator A.yaml --shard {}/4 --output {}.yaml ::: 1 2 3 4\n"
    "  calibration_study --merge --output study.yaml 1.yaml 2.yaml 3.yaml 4.yaml\n"
    "Exit status: 0 the study is written, 2 it is not (and the reason on the standard error).\n";

/// Part i of n, counted from 1.
struct Shard {
  std::uint64_t index = 1;
  std::uint64_t count = 1;
};

struct Options {
  std::string actuator_path;
  std::string config_path;
  std::string output_path;
  std::string plan_path;
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

std::string shortText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// An option that has the target's present value as its default.
template <typename Value>
po::typed_value<Value>* stored(Value& target, const char* unit) {
  std::ostringstream text;
  text << target;
  return po::value<Value>(&target)->default_value(target, text.str())->value_name(unit);
}

po::options_description knownOptions(Options& options) {
  po::options_description known("Options");
  auto add = known.add_options();
  add("help,h", "print this help and exit");
  add("actuator",
      po::value(&options.actuator_path)->value_name("YAML"),
      "actuator description (nominal); needed");
  add("config", po::value(&options.config_path)->value_name("YAML"), "as for calibrate_bag");
  add("output", po::value(&options.output_path)->value_name("YAML"), "study to write; needed");
  add("force", "replace the output if it exists");
  add("merge", po::bool_switch(&options.merge), "join the shards that are given");
  add("trials", stored(options.trials, "N"), "of the whole study");
  add("seed", stored(options.seed, "N"), "of the first trial; each further one counts up");
  add("shard", stored(options.shard_text, "I/N"), "do only part I of N");
  add("threads", stored(options.threads, "N"), "to run trials on");
  add("plan",
      po::value(&options.plan_path)->value_name("YAML"),
      "session planned by plan_session, in the place of the poses and the current below");
  add("plan-seed", stored(options.plan_seed, "N"), "of the poses, the same in all trials");
  add("joint-poses", stored(options.plan.joint_poses, "N"), "poses without current");
  add("main-coil-poses", stored(options.plan.main_coil_poses, "N"), "poses with coil 1 excited");
  add("coil-poses", stored(options.plan.coil_poses, "N"), "poses with each other coil excited");
  add("joint-tilt", stored(options.plan.joint_tilt_share, "SHARE"), "of the tilt limit");
  add("torque-tilt", stored(options.plan.torque_tilt_share, "SHARE"), "of the tilt limit");
  add("current", stored(options.plan.current, "A"), "of an excited coil");
  add("tracker", stored(options.tracker, "first|every"), "at poses without current, or at all");
  add("orientation-noise", stored(options.noise.orientation, "RAD"), "standard deviation");
  add("torque-noise", stored(options.noise.torque, "NM"), "standard deviation");
  add("joint-noise", stored(options.noise.joint, "RAD"), "standard deviation");
  add("offset-error", stored(options.errors.joint_offset, "RAD"), "half width of made offsets");
  add("axis-error", stored(options.errors.joint_axis, "RAD"), "the same of joint axes");
  add("pole-error", stored(options.errors.pole_angle, "RAD"), "the same of pole angles");
  add("coil-error", stored(options.errors.coil_angle, "RAD"), "the same of coil angles");
  return known;
}

void requireOption(const std::string& value, const char* name) {
  if (value.empty()) {
    throw ConfigError(std::string("--") + name + " is needed; see --help.");
  }
}

std::optional<Options> parseOptions(int argc, char** argv) {
  Options options;
  options.plan.validation_poses = 0;
  const po::options_description known = knownOptions(options);
  po::options_description all = known;
  all.add_options()("shards", po::value(&options.shard_paths));
  po::positional_options_description positional;
  positional.add("shards", -1);
  po::variables_map given;
  try {
    po::store(po::command_line_parser(argc, argv).options(all).positional(positional).run(), given);
    po::notify(given);
  } catch (const po::error& error) {
    throw ConfigError(std::string(error.what()) + "; see --help.");
  }
  if (given.count("help") > 0) {
    std::cout << kIntroduction << "\n" << known;
    return std::nullopt;
  }
  if (given.count("force") > 0) {
    options.overwrite = OverwritePolicy::kReplace;
  }
  requireOption(options.output_path, "output");
  if (!options.merge) {
    requireOption(options.actuator_path, "actuator");
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

TrackerUse parseTracker(const std::string& text) {
  if (text == "first") {
    return TrackerUse::kPosesWithoutCurrent;
  }
  if (text == "every") {
    return TrackerUse::kEveryPose;
  }
  throw ConfigError("--tracker: " + text + " is neither first nor every.");
}

/// What the trials depend on.
std::vector<std::pair<std::string, std::string>> settingsOf(const Options& options,
                                                            const Actuator& nominal) {
  return {{"software", PACKAGE_VERSION},
          {"actuator", nominal.name},
          {"tracker", options.tracker},
          {"plan", options.plan_path.empty() ? "random" : options.plan_path},
          {"plan seed", std::to_string(options.plan_seed)},
          {"joint poses", std::to_string(options.plan.joint_poses)},
          {"poses with coil 1", std::to_string(options.plan.main_coil_poses)},
          {"poses with each other coil", std::to_string(options.plan.coil_poses)},
          {"tilt of joint poses [share]", shortText(options.plan.joint_tilt_share)},
          {"tilt of torque poses [share]", shortText(options.plan.torque_tilt_share)},
          {"current [A]", shortText(options.plan.current)},
          {"orientation noise [rad]", shortText(options.noise.orientation)},
          {"torque noise [N·m]", shortText(options.noise.torque)},
          {"joint noise [rad]", shortText(options.noise.joint)},
          {"offset error [rad]", shortText(options.errors.joint_offset)},
          {"axis error [rad]", shortText(options.errors.joint_axis)},
          {"pole error [rad]", shortText(options.errors.pole_angle)},
          {"coil error [rad]", shortText(options.errors.coil_angle)}};
}

std::function<void(double)> terminalProgress() {
  if (::isatty(STDERR_FILENO) == 0) {
    return {};
  }
  return [](double share) {
    std::fprintf(stderr, "\rtrials %3.0f %%%s", 100.0 * share, share < 1.0 ? "" : "\n");
  };
}

StudyRecord run(const Options& options) {
  const Shard shard = parseShard(options.shard_text);
  StudyOptions study;
  study.nominal = loadActuator(options.actuator_path);
  study.plan = options.plan_path.empty()
                   ? planSession(study.nominal, options.plan, options.plan_seed)
                   : sessionOf(loadSessionPlan(options.plan_path), study.nominal);
  study.tracker = parseTracker(options.tracker);
  study.noise = options.noise;
  study.errors = options.errors;
  if (!options.config_path.empty()) {
    study.estimation = loadCalibrationConfig(options.config_path).estimation;
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
                            terminalProgress());
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
