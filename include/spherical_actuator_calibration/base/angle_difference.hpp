#pragma once

#include <cmath>

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {

/// a − b [rad] the shorter way round, within ± π: a full turn makes no difference.
inline double angleDifference(double a, double b) {
  return std::remainder(a - b, 2.0 * kPi);
}

}  // namespace sac
