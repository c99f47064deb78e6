#pragma once

#include <string>

#include "spherical_actuator_calibration/calibration/session_progress.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {

/// What the operator should do next, in a sentence that names the service to call or the samples
/// that are missing.
std::string nextStep(const CalibrationModel& model, const SessionProgress& progress);

}  // namespace sac
