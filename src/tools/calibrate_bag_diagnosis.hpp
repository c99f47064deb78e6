#pragma once

#include <string>
#include <vector>

#include "calibrate_bag_options.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"

namespace sac {

/// A line for each diagnosis, "diagnosis: CAUSE: sentence".
std::string diagnosisLines(const std::vector<Diagnosis>& diagnoses);

/// Judges the description of a session by all its samples. Prints the result; false: it is not
/// valid, or nothing can be told.
bool printCheck(const CalibrationSession& session);

/// Writes what corrects the diagnoses of a session: a description, where it can hold all
/// corrections, or a configuration that models the first effect. Prints which, or what must be
/// corrected elsewhere.
void writeCorrection(const CalibrationSession& session,
                     const std::vector<Diagnosis>& diagnoses,
                     const std::string& path,
                     OverwritePolicy policy);

}  // namespace sac
