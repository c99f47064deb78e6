#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/study/calibration_study.hpp"

namespace sac {

/// A study, or one shard of it, as kept in a file.
struct StudyRecord {
  /// What the trials depend on, as names and values for people. Shards of one study agree in it.
  std::vector<std::pair<std::string, std::string>> settings;
  std::uint64_t first_seed = 1;
  std::uint64_t trial_count = 0;   ///< of the whole study: seeds first_seed, first_seed + 1, …
  std::vector<StudyTrial> trials;  ///< those done, ascending seeds
};

/// Text of a study file: settings, every trial, summary. Loading gives back the trials to the last
/// bit.
std::string renderStudy(const StudyRecord& study);

/// Reads a study file. Throws ConfigError that names file, line and key.
StudyRecord loadStudy(const std::string& path);

/// Joins shards. The result is that of the whole study at once, to the last bit. `names` stand for
/// the shards in messages. Throws DataError that names what does not fit: other settings, a trial
/// that is there twice, or trials that are missing.
StudyRecord mergeStudies(const std::vector<StudyRecord>& shards,
                         const std::vector<std::string>& names);

}  // namespace sac
