#pragma once

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {

/// What one of ParameterSpace::reportedStddevs() counts where the worst is looked for [rad]: zero
/// of an azimuth on the polar axis, which nothing can tell.
inline double definedStddev(double stddev) {
  return stddev < kPi ? stddev : 0.0;
}

}  // namespace sac
