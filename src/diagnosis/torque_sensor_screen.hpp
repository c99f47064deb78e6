#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "wiring_case.hpp"

namespace sac {

/// Faults of the force/torque sensor's channels, by the torques at the nominal description: a
/// channel with a sign or scale of its own, and channels at the end of their range.
std::vector<ScreenedCandidate> screenTorqueSensor(const WiringCase& described,
                                                  const CalibrationConfig& config);

/// What is wrong where most torques, or most readings of one channel, are the same number to the
/// last digit.
std::optional<std::string> stuckTorques(const std::vector<Sample>& samples);

}  // namespace sac
