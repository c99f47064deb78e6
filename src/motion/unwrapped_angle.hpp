#pragma once

#include <cmath>

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {

/// Angles [rad] of the same directions nearest to those before, of a sensor that wraps around.
inline Eigen::Vector3d unwrapped(const Eigen::Vector3d& angles, const Eigen::Vector3d& before) {
  return angles.binaryExpr(before, [](double angle, double last) {
    return angle - 2.0 * kPi * std::round((angle - last) / (2.0 * kPi));
  });
}

}  // namespace sac
