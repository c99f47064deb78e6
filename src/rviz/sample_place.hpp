#pragma once

#include <string>

#include "spherical_actuator_calibration/CalibrationSample.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// At which angles a sample was taken, in degrees: "+12.0°, −8.1°, +20.3°".
std::string anglesOf(const msg::CalibrationSample& sample);

/// With which coils: "coil 3", "coils 3, 7" or "8 coils", those that `threshold` [A] counts as
/// excited; empty of none.
std::string coilsOf(const msg::CalibrationSample& sample, double threshold);

}  // namespace sac
