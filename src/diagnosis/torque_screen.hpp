#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "wiring_case.hpp"

namespace sac {

/// The candidates for the torques of a case that are worth a fit, by their misfit at the nominal
/// description, as expected within the tolerance. `with_joints`: no orientation has judged the
/// joint sensors, so that torques must.
std::vector<ScreenedCandidate> screenTorques(const WiringCase& described,
                                             const CalibrationConfig& config,
                                             bool with_joints);

/// Misfit of a case's torques at the nominal description, as expected within the tolerance [nats].
double torqueLoss(const WiringCase& given, const CalibrationConfig& config);

/// Strengths of the few coils whose torques misfit most where all others may fit: angles that took
/// up a wrong strength hide it from a screen. `fitted`: the case with the parameters that explain
/// its torques best as described.
std::vector<ScreenedCandidate> screenMisfittingCoils(const WiringCase& described,
                                                     const WiringCase& fitted,
                                                     const CalibrationConfig& config);

}  // namespace sac
