#pragma once

#include <optional>
#include <string>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/held_out_validation.hpp"

namespace sac {

/// One cycle for people: its message, errors of all iterations, misfit, rejected samples.
std::string cycleParagraph(const CycleReport& report);

/// The observation that moves the result of the last cycle most; empty when that one failed.
std::string influenceParagraph(const CalibrationSession& session);

/// Whether torque is proportional to current; empty without torques.
std::string linearityParagraph(const CalibrationSession& session);

/// How the held-out samples agree.
std::string validationParagraph(const HeldOutValidation& validation);

/// Names of the parameters that are not identified: those left as they were, and those that take
/// part in an open direction; empty when there is none.
std::string openParagraph(const CalibrationSession& session);

/// All parameters: nominal, identified, change and standard deviation; what the data leave at the
/// nominal value shows no numbers. With the truth also error and error by standard deviation, and
/// how many of the 95 % intervals hold it.
std::string parameterTable(const CalibrationSession& session, const std::optional<Actuator>& truth);

}  // namespace sac
