#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "wiring_case.hpp"

namespace sac {

/// Mistakes of the tracker of a rotor without joints, where torques alone contradict it: those that
/// are worth a fit, by the misfit of the torques at the nominal description.
std::vector<ScreenedCandidate> screenTrackerByTorques(const WiringCase& described,
                                                      const CalibrationConfig& config);

}  // namespace sac
