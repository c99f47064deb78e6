#pragma once

#include <optional>
#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/calibration_record.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"

namespace sac {

/// What an actuator description file holds. A nominal one has no standard deviations and no record.
struct CalibratedDescription {
  Actuator actuator;
  /// As many poles and coils as in `actuator`. For saving, empty lists stand for "none known".
  ParameterStddevs stddevs = {};
  std::optional<CalibrationRecord> calibration = std::nullopt;
};

/// Whether samples that were held out contradicted a description when it was made: not to be used.
bool isContradicted(const CalibratedDescription& description);

/// Whether a description does not tell how well each angle of its axes is known: nobody has
/// calibrated it, or not all of it.
bool isAsDrawn(const CalibratedDescription& description);

/// Reads a description file, nominal or calibrated: one form for both. Joint axes that are unit to
/// 1e-3 only are normalised. Throws ConfigError that names file, line and key for anything unknown,
/// missing, repeated, of the wrong type or out of range.
CalibratedDescription loadDescription(const std::string& path);
/// The same for text in memory; `name` stands for the file in messages.
CalibratedDescription parseDescription(const std::string& text, const std::string& name);
/// The same for a map that was read already, such as parameters of a node.
CalibratedDescription readDescription(const YamlMap& file);
/// The actuator of a description file, nominal or calibrated.
Actuator loadActuator(const std::string& path);

/// Text of a description file: loading gives back the description to the last bit. Throws
/// ConfigError, naming line and key of the text, for a description that could not be loaded again;
/// `name` stands for the file in messages.
std::string renderDescription(const CalibratedDescription& description, const std::string& name);

/// Writes a description file atomically. Throws ConfigError as renderDescription() and DataError as
/// writeFileAtomically().
void saveDescription(const std::string& path,
                     const CalibratedDescription& description,
                     OverwritePolicy policy);

}  // namespace sac
