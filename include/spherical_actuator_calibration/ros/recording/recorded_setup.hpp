#pragma once

#include <optional>
#include <string>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/ros/recording/open_recordings.hpp"

namespace sac {

/// What a recording says of itself, so that it can be calibrated again with nothing beside it: the
/// topics `calibration_description` and `calibration_config`, which the calibration node publishes.
/// Recordings of releases before 0.2, and of other nodes, say nothing.
struct RecordedSetup {
  std::optional<CalibratedDescription>
      description;  ///< of the actuator, at the start of the session
  std::optional<CalibrationConfig> config;
};

/// Which parts are wanted: what is not is not read, so that what is wrong with it does not matter.
struct SetupParts {
  bool description = true;
  bool config = true;
};

/// Reads what the recordings say below the namespace `ns`. As of files, the text is of one YAML
/// document of bounded size and strictly checked: throws ConfigError, naming recording, topic, line
/// and key. Throws DataError when it is recorded as another type, is damaged, or when recordings
/// say different things.
RecordedSetup recordedSetup(const OpenRecordings& recordings,
                            const std::string& ns,
                            const SetupParts& parts);

}  // namespace sac
