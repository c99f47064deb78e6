#include "spherical_actuator_calibration/study/study_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/input_file.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"

namespace sac {
namespace {

constexpr std::size_t kNumbersPerGroup = 4;
constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();

std::string text(const GroupTallies& tallies) {
  std::vector<std::string> numbers;
  for (const GroupTally& group : tallies) {
    numbers.push_back(std::to_string(group.parameters));
    numbers.push_back(std::to_string(group.covered));
    numbers.push_back(yamlNumber(group.squared_error));
    numbers.push_back(yamlNumber(group.squared_bound));
  }
  return yamlList(numbers);
}

std::string trialLine(const StudyTrial& trial) {
  YamlLine line;
  line.add("seed", std::to_string(trial.seed));
  line.add("sequence_converged", yamlBoolean(trial.sequence_converged));
  line.add("refine_converged", yamlBoolean(trial.refine_converged));
  line.add("sequence", text(trial.sequence));
  line.add("refined", text(trial.refined));
  return line.text();
}

std::string text(const StudyErrors& errors) {
  YamlLine line;
  line.add("rms_error", yamlNumber(errors.rms_error));
  line.add("rms_bound", yamlNumber(errors.rms_bound));
  line.add("ratio", yamlNumber(errors.ratio()));
  line.add("coverage", yamlNumber(errors.coverage));
  return line.text();
}

void writeStage(YamlWriter& writer, const std::string& name, const StageSummary& summary) {
  writer.map(2, name);
  writer.entry(3, "trials", std::to_string(summary.trials));
  writer.entry(3, "converged", std::to_string(summary.converged));
  writer.entry(3, "all", text(summary.all));
  for (std::size_t g = 0; g < kParameterGroups; ++g) {
    // An actuator without poles and coils has no such errors.
    if (summary.groups[g].rms_bound > 0.0) {
      writer.entry(3, groupName(static_cast<ParameterGroup>(g)), text(summary.groups[g]));
    }
  }
}

GroupTallies readTallies(const YamlMap& trial, const std::string& key) {
  const std::vector<double> numbers =
      trial.numbers(key, ValueRange::nonNegative(), kNumbersPerGroup * kParameterGroups);
  const auto count = [&](double number) {
    if (number != std::floor(number) || number > std::numeric_limits<std::uint32_t>::max()) {
      trial.fail(key, "has a count that is none: a whole number below 2^32 is needed.");
    }
    return static_cast<std::uint32_t>(number);
  };
  GroupTallies tallies;
  for (std::size_t g = 0; g < kParameterGroups; ++g) {
    const double* group = &numbers[kNumbersPerGroup * g];
    tallies[g] = {count(group[0]), count(group[1]), group[2], group[3]};
  }
  return tallies;
}

std::uint64_t readCount(const YamlMap& map, const std::string& key) {
  return static_cast<std::uint64_t>(map.integer(key, 0, kLargest));
}

StudyTrial readTrial(const YamlMap& map) {
  StudyTrial trial;
  trial.seed = readCount(map, "seed");
  trial.sequence_converged = map.boolean("sequence_converged");
  trial.refine_converged = map.boolean("refine_converged");
  trial.sequence = readTallies(map, "sequence");
  trial.refined = readTallies(map, "refined");
  return trial;
}

}  // namespace

std::string renderStudy(const StudyRecord& study) {
  std::vector<std::string> settings;
  for (const auto& [name, value] : study.settings) {
    settings.push_back("{name: " + yamlText(name) + ", value: \"" + value + "\"}");
  }
  std::vector<std::string> trials;
  for (const StudyTrial& trial : study.trials) {
    trials.push_back(trialLine(trial));
  }
  YamlWriter writer;
  writer.map(0, "study");
  writer.list(1, "settings", settings);
  writer.entry(1, "first_seed", std::to_string(study.first_seed));
  writer.entry(1, "trial_count", std::to_string(study.trial_count));
  writer.map(1, "summary");
  writeStage(writer, "sequence", summarizeSequence(study.trials));
  writeStage(writer, "refinement", summarizeRefinement(study.trials));
  writer.line(1,
              "# per group (offsets, joint_axes, poles, coils, effects): parameters, how many "
              "within their");
  writer.line(1, "# 95 % interval, sum of squared errors, sum of variances at the bound [rad^2]");
  writer.list(1, "trials", trials);
  return writer.text();
}

StudyRecord loadStudy(const std::string& path) {
  const YamlMap file = YamlMap::parse(readInputFile(path), path);
  const YamlMap map = file.map("study");
  StudyRecord study;
  for (const YamlMap& setting : map.maps("settings")) {
    study.settings.emplace_back(setting.text("name"), setting.text("value"));
  }
  study.first_seed = readCount(map, "first_seed");
  study.trial_count = readCount(map, "trial_count");
  for (const YamlMap& trial : map.maps("trials")) {
    study.trials.push_back(readTrial(trial));
  }
  return study;
}

StudyRecord mergeStudies(const std::vector<StudyRecord>& shards,
                         const std::vector<std::string>& names) {
  if (shards.empty()) {
    throw DataError("There is no study to merge.");
  }
  StudyRecord whole = shards.front();
  for (std::size_t n = 1; n < shards.size(); ++n) {
    const StudyRecord& shard = shards[n];
    if (shard.settings != whole.settings || shard.first_seed != whole.first_seed ||
        shard.trial_count != whole.trial_count) {
      throw DataError(names[n] + ": its settings are not those of " + names.front() +
                      "; only shards of one study can be merged.");
    }
    whole.trials.insert(whole.trials.end(), shard.trials.begin(), shard.trials.end());
  }
  std::sort(whole.trials.begin(), whole.trials.end(), [](const StudyTrial& a, const StudyTrial& b) {
    return a.seed < b.seed;
  });
  for (std::size_t n = 0; n < whole.trials.size() || n < whole.trial_count; ++n) {
    const std::uint64_t expected = whole.first_seed + n;
    if (n >= whole.trials.size() || whole.trials[n].seed > expected) {
      throw DataError("The trial with seed " + std::to_string(expected) +
                      " is in no shard: a shard is missing.");
    }
    if (whole.trials[n].seed < expected || n >= whole.trial_count) {
      throw DataError("The trial with seed " + std::to_string(whole.trials[n].seed) +
                      " is there twice: a shard was given twice.");
    }
  }
  return whole;
}

}  // namespace sac
