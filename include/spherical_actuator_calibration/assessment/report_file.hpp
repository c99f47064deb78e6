#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/diagnosis/diagnosis.hpp"

namespace sac {

/// All figures of a calibration as YAML, for programs: origin, verdict, configuration, samples,
/// every cycle with its estimates and residuals, validation, parameters in force, coverage,
/// uncertainty over the workspace. Angles in rad, torques in N·m. `recording` tells in words what
/// became of the recordings, one line each;
/// `diagnoses`: what was found, where it was looked for.
std::string renderReport(const CalibrationSession& session,
                         const CalibrationOrigin& origin,
                         const std::vector<std::string>& recording,
                         const std::vector<Diagnosis>& diagnoses = {});

/// Name of the grade that such a file tells; empty where there is no file, or none of a grade. Only
/// its begin is read: a report of many samples is large.
std::string gradeInReport(const std::string& path);

}  // namespace sac
