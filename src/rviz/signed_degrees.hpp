#pragma once

#include <cmath>
#include <string>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {

/// "+12.3°" of an angle [rad]: by how much, and which way, a hand is to turn.
inline std::string signedDegrees(double angle) {
  return (angle < 0.0 ? "−" : "+") + format("%.1f°", std::abs(angle) / kOneDegree);
}

}  // namespace sac
