#pragma once

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Of the control loop, as a stamp and as a time [s].
inline constexpr Stamp kCycle = 1000000;  // 1 ms
inline constexpr double kStep = 1e-3;

}  // namespace sac
