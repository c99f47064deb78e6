#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "spherical_actuator_calibration/assessment/calibration_grade.hpp"
#include "spherical_actuator_calibration/storage/calibration_directory.hpp"
#include "spherical_actuator_calibration/storage/live_session.hpp"

namespace sac {

/// A robot description that is not ours, to be calibrated.
struct RobotDescription {
  std::optional<std::string> urdf;  ///< nothing: there is none
  std::string source;               ///< what names it in messages
};

/// The files of the parameters in force in a calibration directory: calibrated description, robot
/// description, report. Functions throw DataError and ConfigError when one cannot be made or
/// written; files of a revision that are there with another content are never replaced.
class CalibrationFiles {
 public:
  explicit CalibrationFiles(const CalibrationDirectory& directory) : directory_(directory) {}

  /// Whether the description of a revision is there. Where held-out samples agree (`grade`: good or
  /// usable) its report must tell that grade, too: one from before they judged is to be saved anew.
  bool isSaved(std::uint32_t revision, Grade grade) const;

  /// Writes the calibrated description and, where there is a robot description, the calibrated one.
  /// A description tells what held-out samples say: where that, or anything else of it, is other
  /// than in the file that is there, the new one has the next free number in its name.
  /// Nothing is written when either cannot be made. Returns the sentence that names the files.
  /// Throws DataError when nothing is calibrated yet.
  std::string save(const LiveSession& session, const RobotDescription& robot) const;

  /// Writes report.yaml, with the figures of the present samples, into the folder for the report of
  /// the revision in force; returns the folder.
  std::string saveReport(const LiveSession& session) const;

 private:
  std::string reportFile(std::uint32_t revision) const;

  const CalibrationDirectory& directory_;
};

}  // namespace sac
