#pragma once

#include <optional>
#include <string>

#include "spherical_actuator_calibration/core/calibration_report.hpp"
#include "spherical_actuator_calibration/core/calibration_session.hpp"
#include "spherical_actuator_calibration/core/held_out_validation.hpp"

namespace spherical_actuator_calibration {

/// One cycle for people: its message, errors of all iterations, misfit, rejected samples.
std::string cycleParagraph(const CycleReport& report);

/// The observation that moves the result of the last cycle most; empty when that one failed.
std::string influenceParagraph(const CalibrationSession& session);

/// How the held-out samples agree.
std::string validationParagraph(const HeldOutValidation& validation);

/// All parameters: nominal, identified, change and standard deviation; what is not identified shows
/// no numbers. With the truth also error and error by standard deviation, and how many of the 95 %
/// intervals hold it.
std::string parameterTable(const CalibrationSession& session, const std::optional<Actuator>& truth);

}  // namespace spherical_actuator_calibration
