#pragma once

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Stamps of a clock that shows a time of 2020, and of streams at 100 Hz.
inline constexpr Stamp kSecond = 1'000'000'000;
inline constexpr Stamp kNow = 1'600'000'000 * kSecond;
inline constexpr Stamp kPeriod = kSecond / 100;

}  // namespace sac
