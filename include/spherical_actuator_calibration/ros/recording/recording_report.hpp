#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/streams/sample_builder_report.hpp"

namespace sac {

/// What became of the raw streams of recordings.
struct RecordedStreamsReport {
  SampleBuilderReport samples;                    ///< what was made of the streams
  std::uint64_t incomplete_joint_states = 0;      ///< without one of the joints: dropped
  std::uint64_t orientations_in_other_frame = 0;  ///< dropped
  std::uint64_t torques_in_other_frame = 0;       ///< dropped
};

/// What became of samples that were recorded as such.
struct RecordedSamplesReport {
  /// Reasons beyond this number are counted only.
  static constexpr std::size_t kMaxReasons = 20;

  std::uint64_t received = 0;
  std::uint64_t repeated = 0;  ///< recorded twice: dropped
  std::uint64_t invalid = 0;   ///< dropped
  std::vector<std::string> invalid_reasons;
};

/// What became of the content of recordings.
struct RecordingReport {
  bool has_streams = false;  ///< samples were made from raw streams
  RecordedStreamsReport streams;
  bool has_samples = false;  ///< samples were recorded as such
  RecordedSamplesReport samples;
  std::vector<std::string> notes;    ///< what an operator should know, one sentence each
  std::vector<std::string> missing;  ///< what samples of dwells lack, likewise; motion needs less
};

/// All of it for people, one line each: counts of every stream, what was dropped and why, notes.
std::vector<std::string> describe(const RecordingReport& report);

}  // namespace sac
