#pragma once

#include <cstdint>
#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// The folder that holds everything a calibration of one unit writes. Names that come from the
/// description cannot lead out of it.
class CalibrationDirectory {
 public:
  /// Makes the folder where it is missing. `directory` is its path; empty:
  /// $ROS_HOME/spherical_actuator_calibration/<serial, or name where there is none>, with ~/.ros
  /// where ROS_HOME is not set. Throws ConfigError when name or serial cannot be a file name or
  /// there is no home, and DataError when the folder cannot be made or written.
  CalibrationDirectory(const std::string& directory, const Actuator& actuator);

  /// Absolute path of the folder.
  const std::string& path() const { return path_; }
  /// Path of the session database.
  std::string database() const;
  /// Path of the calibrated description of a revision: <name>_revision_<number>.yaml, and
  /// <name>_revision_<number>_<edition>.yaml from the second edition on.
  std::string description(std::uint32_t revision, unsigned edition = 1) const;
  /// Path of the calibrated URDF of a revision.
  std::string urdf(std::uint32_t revision) const;
  /// Path of the folder for the report of a revision: report_revision_<number>.
  std::string report(std::uint32_t revision) const;

 private:
  std::string revisionFile(std::uint32_t revision, const std::string& ending) const;

  std::string path_;
  std::string name_;
};

}  // namespace sac
