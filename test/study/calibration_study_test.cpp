#include "spherical_actuator_calibration/study/calibration_study.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/study/study_file.hpp"
#include "support/error_message.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

StudyOptions paperStudy() {
  StudyOptions options;
  options.nominal = scenarios::paperNominal();
  options.plan = planSession(options.nominal, {}, 1);
  return options;
}

/// Shards i of `count`, as a job array would run them.
std::vector<StudyRecord> shards(const StudyOptions& options, std::uint64_t count) {
  std::vector<StudyRecord> result;
  for (std::uint64_t i = 0; i < count; ++i) {
    result.push_back({{{"actuator", "test"}}, 1, 7, runTrials(options, 1 + i, 8, count, 2)});
  }
  return result;
}

TEST(CalibrationStudy, RefinementReachesTheBoundAndItsIntervalsHold) {
  const std::vector<StudyTrial> trials = runTrials(paperStudy(), 1, 41, 1, 2);
  const StageSummary refined = summarizeRefinement(trials);
  EXPECT_EQ(refined.trials, 40U);
  EXPECT_EQ(refined.converged, 40U);
  EXPECT_NEAR(refined.all.ratio(), 1.0, 0.06);
  EXPECT_NEAR(refined.all.coverage, 0.95, 0.02);
  const StageSummary sequence = summarizeSequence(trials);
  EXPECT_EQ(sequence.converged, 40U);
  EXPECT_GT(sequence.all.ratio(), 1.5);
  EXPECT_EQ(sequence.all.rms_bound, refined.all.rms_bound);
}

TEST(CalibrationStudy, TheNumberOfThreadsDoesNotMatter) {
  const StudyRecord one{{}, 1, 5, runTrials(paperStudy(), 1, 6, 1, 1)};
  const StudyRecord three{{}, 1, 5, runTrials(paperStudy(), 1, 6, 1, 3)};
  EXPECT_EQ(renderStudy(one), renderStudy(three));
}

TEST(CalibrationStudy, ShardsMergeToTheWholeToTheLastBit) {
  const StudyOptions options = paperStudy();
  const StudyRecord whole{{{"actuator", "test"}}, 1, 7, runTrials(options, 1, 8, 1, 2)};
  const TemporaryFolder folder;
  std::vector<StudyRecord> loaded;
  std::vector<std::string> names;
  for (const StudyRecord& shard : shards(options, 3)) {
    names.push_back(std::to_string(names.size()));
    loaded.push_back(loadStudy(folder.write(names.back(), renderStudy(shard))));
  }
  EXPECT_EQ(renderStudy(mergeStudies(loaded, names)), renderStudy(whole));
}

TEST(CalibrationStudy, ThousandsOfTrialsAreReadAgain) {
  StudyRecord many{{}, 1, 5000, {}};
  many.trials.resize(5000);
  const std::string text = renderStudy(many);
  EXPECT_GT(text.size(), std::size_t{1} << 20U);
  const TemporaryFolder folder;
  EXPECT_EQ(loadStudy(folder.write("study.yaml", text)).trials.size(), 5000U);
}

TEST(CalibrationStudy, NamesACountThatIsNone) {
  StudyRecord study{{}, 1, 1, {}};
  study.trials.resize(1);
  const TemporaryFolder folder;
  for (const char* count : {"1e119", "0.5"}) {
    std::string text = renderStudy(study);
    const std::string begin = "sequence: [";
    text.replace(text.find(begin) + begin.size(), 1, count);
    const std::string path = folder.write("study.yaml", text);
    const std::string message = errorMessage<ConfigError>([&] { loadStudy(path); });
    EXPECT_NE(message.find("trials[0].sequence"), std::string::npos) << message;
    EXPECT_NE(message.find("a whole number below 2^32"), std::string::npos) << message;
  }
}

TEST(CalibrationStudy, NamesWhatDoesNotFitInAMerge) {
  const std::vector<StudyRecord> parts = shards(paperStudy(), 2);
  const auto message = [](const std::vector<StudyRecord>& given) {
    return errorMessage<DataError>([&] { mergeStudies(given, {"a.yaml", "b.yaml", "c.yaml"}); });
  };
  EXPECT_NE(message({parts[0]}).find("seed 2 is in no shard"), std::string::npos);
  EXPECT_NE(message({parts[0], parts[1], parts[1]}).find("twice"), std::string::npos);
  StudyRecord other = parts[1];
  other.settings[0].second = "another";
  EXPECT_NE(message({parts[0], other}).find("b.yaml: its settings"), std::string::npos);
}

TEST(CalibrationStudy, CountsTrialsThatDoNotConverge) {
  StudyOptions options = paperStudy();
  options.errors.pole_angle = 0.4;
  options.errors.coil_angle = 0.4;
  const StageSummary refined = summarizeRefinement(runTrials(options, 1, 5, 1, 2));
  EXPECT_EQ(refined.trials, 4U);
  EXPECT_LT(refined.converged, 4U);
}

TEST(CalibrationStudy, RefusesOptionsOutOfRange) {
  StudyOptions options = paperStudy();
  options.noise.torque = -1.0;
  EXPECT_THROW(runTrials(options, 1, 3, 1, 2), ConfigError);
}

}  // namespace
}  // namespace sac
