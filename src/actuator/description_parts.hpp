#pragma once

#include <optional>
#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/calibration_record.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/base/yaml_writer.hpp"

// Parts of a description file that are forms of their own. Readers throw ConfigError that names
// file, line and key; writers write what the readers read, to the last bit.

namespace sac {

/// torque_curve of the map of an actuator: a polynomial, a table, or both. A table that is a file
/// is looked for beside the description.
TorqueCurveDescription readTorqueCurve(const YamlMap& actuator);
std::string torqueCurveLine(const TorqueCurveDescription& curve);

/// linear and harmonics of a joint or of its stddev; nothing where they are absent.
std::optional<std::array<double, kJoints>> readLinear(const YamlMap& joint);
std::optional<std::array<double, 4>> readHarmonics(const YamlMap& joint);

/// orientation_map of the map of an actuator; null where it is absent.
std::shared_ptr<const OrientationMap> readOrientationMap(const YamlMap& actuator);
void writeOrientationMap(YamlWriter& writer, const OrientationMap& map);

/// covariance of the map of a calibration.
CovarianceRecord readCovariance(const YamlMap& calibration);
void writeCovariance(YamlWriter& writer, const CovarianceRecord& covariance);

}  // namespace sac
