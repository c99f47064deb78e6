#pragma once

#include <string>

namespace spherical_actuator_calibration {

/// Date and time by the clock of this machine, in UTC: 2024-05-31T12:00:00Z.
std::string utcDate();

}  // namespace spherical_actuator_calibration
