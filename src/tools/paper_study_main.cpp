#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"
#include "spherical_actuator_calibration/study/paper_control_study.hpp"
#include "spherical_actuator_calibration/study/paper_study.hpp"
#include "tool_main.hpp"

namespace sac {
namespace {

/// Gravity torque that loads the rotor beside its centre [N·m] (doc/method.md, Dynamics).
const Eigen::Vector3d& load() {
  static const Eigen::Vector3d value(0.0, 8.8e-3, 0.0);
  return value;
}
constexpr std::uint64_t kSessions = 20;  // of the study of torque errors
constexpr std::size_t kWorkspacePoses = 500;
constexpr int kDrawnPoint = 20;  // every so many points of a closed loop are written
constexpr std::size_t kTableIterations = 4;
constexpr std::pair<Orientations, const char*> kOrientations[] = {
    {Orientations::kRandom, "random"},
    {Orientations::kLargeTorque, "of large torque"},
    {Orientations::kPlanned, "planned"}};
constexpr double kProbabilities[] = {0.0, 0.05, 0.5, 0.95, 1.0};

struct Options {
  std::string nominal_path;
  std::string truth_path;
  std::string output_path;
  OverwritePolicy overwrite = OverwritePolicy::kRefuse;
  std::uint64_t seeds = 200;
};

std::optional<Options> parseOptions(int argc, char** argv) {
  Options options;
  CommandLine line(
      "Usage: paper_study --actuator NOMINAL.yaml --truth TRUTH.yaml --output STUDY.yaml\n\n"
      "Simulates what the paper's section 4.3 does, on many random sets of orientations.\n"
      "study/paper_study draws tables and figures of it.\n\n");
  line.addRequiredInput("actuator", options.nominal_path, "YAML", "the actuator as drawn");
  line.addRequiredInput("truth", options.truth_path, "YAML", "the actuator as made");
  line.addRequiredOutput("output", options.output_path, "YAML", "results to write");
  line.add("seeds", options.seeds, "N", "random sets of orientations per simulation");
  line.addForce(options.overwrite);
  if (!line.parse(argc, argv, std::cout)) {
    return std::nullopt;
  }
  return options;
}

/// Quantiles of kProbabilities, "[...]".
std::string spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<std::string> quantiles;
  for (const double probability : kProbabilities) {
    const auto last = static_cast<double>(values.size() - 1);
    quantiles.push_back(
        yamlNumber(values[static_cast<std::size_t>(std::lround(probability * last))]));
  }
  return yamlList(quantiles);
}

/// One number per run, in the order of the seeds, to six digits.
template <typename Run>
std::string valuesOf(const std::vector<Run>& runs, const std::function<double(const Run&)>& value) {
  std::vector<std::string> values;
  values.reserve(runs.size());
  for (const Run& run : runs) {
    values.push_back(format("%.6e", value(run)));
  }
  return yamlList(values);
}

template <typename Run>
std::string spreadOf(const std::vector<Run>& runs, const std::function<double(const Run&)>& value) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const Run& run : runs) {
    values.push_back(value(run));
  }
  return spread(values);
}

/// Spread per iteration, over runs of different lengths: a run that has ended stays at its last.
template <typename Run>
std::string spreadPerIteration(const std::vector<Run>& runs, std::vector<double> Run::*history) {
  std::size_t longest = 0;
  for (const Run& run : runs) {
    longest = std::max(longest, (run.*history).size());
  }
  std::vector<std::string> lines;
  for (std::size_t n = 0; n < longest; ++n) {
    std::vector<double> values;
    for (const Run& run : runs) {
      const std::vector<double>& all = run.*history;
      if (!all.empty()) {
        values.push_back(all[std::min(n, all.size() - 1)]);
      }
    }
    lines.push_back(spread(values));
  }
  return yamlList(lines);
}

/// How many runs took so many iterations: "{3: 20, 4: 180}".
template <typename Run>
std::string iterationCounts(const std::vector<Run>& runs) {
  std::vector<std::size_t> counts;
  for (const Run& run : runs) {
    const std::size_t iterations = run.errors.empty() ? 0 : run.errors.size() - 1;
    counts.resize(std::max(counts.size(), iterations + 1), 0);
    ++counts[iterations];
  }
  YamlLine line;
  for (std::size_t n = 0; n < counts.size(); ++n) {
    if (counts[n] > 0) {
      line.add(std::to_string(n), std::to_string(counts[n]));
    }
  }
  return line.text();
}

class Study {
 public:
  explicit Study(const PaperStudyOptions& options) : options_(options) {}

  std::string text() {
    writer_.line(0,
                 "# Results of paper_study. Spreads are minimum, 5 %, median, 95 % and maximum "
                 "over the seeds.");
    writer_.entry(0, "seeds", std::to_string(options_.seeds));
    levelOne();
    levelOneNoise("level_1_noise", PaperStudyOptions::NoiseSide::kStator);
    levelOneNoise("level_1_noise_of_rotor_side", PaperStudyOptions::NoiseSide::kRotor);
    tableFive();
    situation("situation_1", Situation::kPolesAndCoil, {10, 15, 20, 25, 30, 40}, 30);
    situation("situation_2", Situation::kCoil, {2, 3, 4, 6, 8, 12, 20}, 4);
    control();
    torqueErrors();
    return writer_.text();
  }

 private:
  static void tell(const char* what) { std::fprintf(stderr, "paper_study: %s\n", what); }

  void levelOne() {
    tell("level 1 without noise");
    const std::vector<LevelOneRun> runs = studyLevelOne(options_);
    writer_.map(0, "level_1");
    writer_.entry(1, "iterations", iterationCounts(runs));
    writer_.entry(1, "initial", valuesOf<LevelOneRun>(runs, [](const LevelOneRun& run) {
                    return run.errors.front();
                  }));
    writer_.entry(1, "epsilon_1", spreadPerIteration(runs, &LevelOneRun::errors));
    writer_.entry(1, "epsilon_1_chord", spreadPerIteration(runs, &LevelOneRun::errors_chord));
    writer_.entry(
        1, "axis_deviation_newton", spreadPerIteration(runs, &LevelOneRun::axis_deviation_newton));
    writer_.entry(
        1, "axis_deviation_chord", spreadPerIteration(runs, &LevelOneRun::axis_deviation_chord));
    writer_.entry(1,
                  "offset_deviation_chord",
                  spreadPerIteration(runs, &LevelOneRun::offset_deviation_chord));
    tableFour(runs.front());
  }

  /// Differences of the identified axes from nominal, by iteration, for the first seed.
  void tableFour(const LevelOneRun& run) {
    const Eigen::Matrix3d nominal = jointGeometry(options_.nominal.joints).axes;
    writer_.map(0, "table_4");
    for (std::size_t n = 1; n <= kTableIterations; ++n) {
      std::vector<std::string> axes;
      for (Eigen::Index k = 0; k < nominal.cols(); ++k) {
        const Eigen::Vector3d difference = run.chord[n].axes.col(k) - nominal.col(k);
        axes.push_back(format("[%.6f, %.6f, %.6f]", difference[0], difference[1], difference[2]));
      }
      writer_.entry(1, std::to_string(n), yamlList(axes));
    }
  }

  /// Identified angles of poles and coil 1, without and with noise, for the first seed.
  void tableFive() {
    PaperStudyOptions one = options_;
    one.seeds = 1;
    constexpr std::size_t kMeasurements = 30;
    const auto estimates = [&](bool noise) {
      return studyLevelTwo(
                 one, Situation::kPolesAndCoil, Orientations::kPlanned, kMeasurements, noise)
          .front()
          .estimates;
    };
    const std::vector<ParameterEstimate> exact = estimates(false);
    const std::vector<ParameterEstimate> noisy = estimates(true);
    writer_.map(0, "table_5");
    for (std::size_t p = 0; p < std::min(exact.size(), noisy.size()); ++p) {
      YamlLine line;
      line.add("name", yamlText(exact[p].name));
      line.add("nominal", format("%.6f", exact[p].nominal));
      line.add("without_noise", format("%.6f", exact[p].value));
      line.add("with_noise", format("%.6f", noisy[p].value));
      line.add("stddev", format("%.6f", noisy[p].stddev));
      writer_.line(1, "- " + line.text());
    }
  }

  void levelOneNoise(const char* name, PaperStudyOptions::NoiseSide side) {
    tell("level 1 with noise");
    PaperStudyOptions options = options_;
    options.noise_side = side;
    writer_.map(0, name);
    constexpr std::size_t kCounts[] = {2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 35, 40};
    for (const std::size_t count : kCounts) {
      const auto runs = studyLevelOneNoise(options, count);
      using Run = LevelOneNoiseRun;
      const auto below = std::count_if(
          runs.begin(), runs.end(), [](const Run& run) { return run.error < run.added_noise; });
      YamlLine line;
      line.add("orientations", std::to_string(count));
      line.add("added_noise", spreadOf<Run>(runs, [](const Run& run) { return run.added_noise; }));
      line.add("epsilon_1", spreadOf<Run>(runs, [](const Run& run) { return run.error; }));
      line.add("epsilon_1_paper",
               spreadOf<Run>(runs, [](const Run& run) { return run.paper_error; }));
      line.add("true_error", spreadOf<Run>(runs, [](const Run& run) { return run.true_error; }));
      line.add("seeds_below_noise", std::to_string(below));
      writer_.line(1, "- " + line.text());
    }
  }

  void situation(const std::string& name,
                 Situation situation,
                 const std::vector<std::size_t>& counts,
                 std::size_t papers_count) {
    tell(name.c_str());
    writer_.map(0, name);
    using Run = LevelTwoRun;
    const auto observable = [](std::vector<Run> runs) {
      runs.erase(
          std::remove_if(runs.begin(), runs.end(), [](const Run& run) { return !run.observable; }),
          runs.end());
      return runs;
    };
    const std::vector<Run> exact =
        observable(studyLevelTwo(options_, situation, Orientations::kRandom, papers_count, false));
    writer_.entry(1, "measurements", std::to_string(papers_count));
    writer_.entry(1, "observable_sets", std::to_string(exact.size()));
    if (!exact.empty()) {
      writer_.entry(1, "iterations", iterationCounts(exact));
      writer_.entry(
          1, "initial", valuesOf<Run>(exact, [](const Run& run) { return run.errors.front(); }));
      writer_.entry(1, "epsilon_2", spreadPerIteration(exact, &Run::errors));
      writer_.entry(1, "largest_error", spreadOf<Run>(exact, [](const Run& run) {
                      return run.largest_error;
                    }));
    }
    writer_.map(1, "noise");
    for (const std::size_t count : counts) {
      for (const auto& [orientations, words] : kOrientations) {
        const std::vector<Run> runs =
            observable(studyLevelTwo(options_, situation, orientations, count, true));
        YamlLine line;
        line.add("measurements", std::to_string(count));
        line.add("orientations", words);
        line.add("observable_sets", std::to_string(runs.size()));
        if (!runs.empty()) {
          line.add("epsilon_2",
                   spreadOf<Run>(runs, [](const Run& run) { return run.errors.back(); }));
          line.add("largest_error",
                   spreadOf<Run>(runs, [](const Run& run) { return run.largest_error; }));
          line.add("largest_share",
                   spreadOf<Run>(runs, [](const Run& run) { return run.largest_share; }));
          if (count == papers_count) {
            line.add("largest_shares",
                     valuesOf<Run>(runs, [](const Run& run) { return run.largest_share; }));
          }
        }
        writer_.line(2, "- " + line.text());
      }
    }
  }

  void control() {
    tell("closed loop");
    writer_.map(0, "control");
    for (const ControlRun& run : studyControl(options_, load())) {
      std::vector<std::string> times;
      std::vector<std::string> errors;
      std::vector<std::string> angles;
      double largest = 0.0;
      for (std::size_t n = 0; n < run.result.points.size(); ++n) {
        const ClosedLoopPoint& point = run.result.points[n];
        largest = std::max(largest, point.rotation_error);
        if (n % kDrawnPoint == 0) {
          times.push_back(yamlNumber(point.time));
          errors.push_back(yamlNumber(point.rotation_error));
          angles.push_back(yamlNumber(point.joint_position[0]));
        }
      }
      writer_.line(1, "- model: " + run.model);
      writer_.entry(2, "loaded", yamlBoolean(run.loaded));
      writer_.entry(2, "completed", yamlBoolean(run.result.completed));
      writer_.entry(2, "final_error", yamlNumber(run.result.points.back().rotation_error));
      writer_.entry(2, "largest_error", yamlNumber(largest));
      writer_.entry(2, "time", yamlList(times));
      writer_.entry(2, "rotation_error", yamlList(errors));
      writer_.entry(2, "q_1", yamlList(angles));
    }
  }

  void torqueErrors() {
    tell("torque over the workspace");
    writer_.map(0, "torque_errors");
    for (const double tilt : {options_.torque_tilt, options_.joint_tilt}) {
      for (const TorqueErrorRun& run :
           studyTorqueErrors(options_, kSessions, kWorkspacePoses, tilt)) {
        using Error = TorqueMatrixError;
        double sum = 0.0;
        for (const Error& error : run.poses) {
          sum += error.error / static_cast<double>(run.poses.size());
        }
        YamlLine line;
        line.add("model", run.model);
        line.add("tilt", yamlNumber(tilt));
        line.add("mean", yamlNumber(sum));
        line.add("spread", spreadOf<Error>(run.poses, [](const Error& e) { return e.error; }));
        line.add("smallest_singular_value", spreadOf<Error>(run.poses, [](const Error& e) {
                   return e.smallest_singular_value;
                 }));
        line.add("condition_number",
                 spreadOf<Error>(run.poses, [](const Error& e) { return e.condition_number; }));
        writer_.line(1, "- " + line.text());
      }
    }
  }

  PaperStudyOptions options_;
  YamlWriter writer_;
};

void writeStudy(const Options& options) {
  requireNewFile(options.output_path, options.overwrite);
  PaperStudyOptions study;
  study.nominal = loadActuator(options.nominal_path);
  study.truth = loadActuator(options.truth_path);
  study.seeds = options.seeds;
  validate(study);
  writeFileAtomically(options.output_path, Study(study).text(), options.overwrite);
}

}  // namespace
}  // namespace sac

int main(int argc, char** argv) {
  return sac::runTool("paper_study", [&] {
    const auto options = sac::parseOptions(argc, argv);
    if (options) {
      sac::writeStudy(*options);
    }
    return sac::kToolSuccess;
  });
}
