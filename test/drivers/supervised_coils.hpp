#pragma once

#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"

namespace sac {

inline constexpr double kWall = 1.7e9;  // [s] wall clock when the steady clock shows 0

inline const SupervisorLimits& limits() {
  static const SupervisorLimits values{0.25, 0.1, 0.15, 4, 0.005};
  return values;
}

inline Eigen::VectorXd amperes(double first, double second = 0.0) {
  return Eigen::Vector2d(first, second);
}

/// A moment by two clocks that agree.
inline Instant at(double steady) {
  return {steady, kWall + steady};
}

/// Given by `caller` at a time of the steady clock.
inline CoilCommand given(const std::string& caller, double steady, double current = 1.0) {
  return {caller, kWall + steady, amperes(current)};
}

}  // namespace sac
