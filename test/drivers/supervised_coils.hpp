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

/// What is set in a coil, and what is measured [A].
struct Flow {
  double set = 0.0;
  double measured = 0.0;
  int beats = 1;
};

/// A moment by two clocks that agree.
inline Instant at(double steady) {
  return {steady, kWall + steady};
}

/// Zero is measured for the last time of the past [s], and once long before: nothing that was set
/// before the supervisor began is on its way any more.
inline void beginAtZero(CurrentSupervisor& supervisor, double steady) {
  for (const double time : {steady - 1.0, steady}) {
    supervisor.observe(amperes(0.0), time, time);
  }
}

/// Given by `caller` at a time of the steady clock.
inline CoilCommand given(const std::string& caller, double steady, double current = 1.0) {
  return {caller, kWall + steady, amperes(current)};
}

}  // namespace sac
