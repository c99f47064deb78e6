#pragma once

#include <functional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"
#include "spherical_actuator_calibration/ros/recording/open_recordings.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_report.hpp"
#include "spherical_actuator_calibration/streams/sample_builder_options.hpp"

namespace sac {

/// What samples are taken from.
enum class SampleSource {
  kSamplesWhereRecorded,  ///< the topic `samples` of recordings that have it, else the raw streams
  kSamples,               ///< the topic `samples`
  /// The raw streams; where samples were recorded, too, the stretches of them that these were
  /// averaged over
  kStreams,
  kDwells,  ///< the raw streams: every rest of the rotor, whatever was recorded as samples
};

/// When the raw streams are kept for calibration in motion.
enum class MotionUse { kNever, kWithoutTorques, kAlways };

/// How recordings are read.
struct RecordingOptions {
  std::string ns = "/actuator";  ///< namespace of the actuator's topics
  MeasurementFrames frames;
  SampleBuilderOptions samples;
  SampleSource source = SampleSource::kSamplesWhereRecorded;
  MotionUse motion = MotionUse::kNever;
  std::function<void(double)>
      progress;  ///< told the share done (0 to 1) now and then; may be empty
};

/// Samples of recordings, and how they were obtained.
struct Recording {
  std::vector<Sample> samples;  ///< ids are unique
  MotionRecording motion;       ///< raw streams, where they are wanted
  RecordingReport report;
};

/// Reads the samples of one actuator out of recordings: from the topic `samples`, or from the raw
/// streams by a SampleBuilder. Bags are read in the order of their begin; those recorded side by
/// side are read as one. Beside what is wanted of motion, memory grows with the number of their
/// chunks, not of their messages.
///
/// Throws DataError, naming the file, for bags that cannot be read, that miss topics, are of
/// another actuator, unit or number of coils, or whose measurements are all in another frame.
/// Throws ConfigError when the options are not valid.
Recording readRecordings(const OpenRecordings& recordings,
                         const Actuator& nominal,
                         const RecordingOptions& options);
/// The same for recordings that are closed.
Recording readRecordings(const std::vector<std::string>& paths,
                         const Actuator& nominal,
                         const RecordingOptions& options);

}  // namespace sac
