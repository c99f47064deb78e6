#pragma once

#include <string>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"

namespace sac {

/// What a calibration is worth, from best to worst. Nothing is good that held-out measurements have
/// not judged.
enum class Grade {
  kGood,          ///< every parameter is identified as well as wanted, held-out samples agree
  kUsable,        ///< held-out samples agree; some parameters or a wanted accuracy are missing
  kNotValidated,  ///< no held-out measurement judges what was identified
  kContradicted,  ///< held-out samples disagree with the parameters
  kFailed,        ///< nothing is identified
};

/// good, usable, not_validated, contradicted, failed: as in messages and reports.
std::string gradeName(Grade grade);

/// A grade with its reason.
struct GradedCalibration {
  Grade grade = Grade::kFailed;
  std::string reason;  ///< the whole result in a sentence or two
};

/// Grades the parameters in force of a session, by what is identified and what held-out samples
/// say. A cycle that failed changed nothing, and does not count.
GradedCalibration gradeCalibration(const CalibrationSession& session);

}  // namespace sac
