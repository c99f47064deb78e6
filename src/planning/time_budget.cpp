#include "spherical_actuator_calibration/planning/time_budget.hpp"

#include <chrono>
#include <cmath>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

std::function<bool()> timeIsUpAfter(double seconds) {
  if (seconds == 0.0) {
    return {};
  }
  if (!std::isfinite(seconds) || seconds < 0.0) {
    throw ConfigError("time_budget: it is a time in s, or 0 to plan to the end.");
  }
  using Clock = std::chrono::steady_clock;
  return [begin = Clock::now(), seconds] {
    return std::chrono::duration<double>(Clock::now() - begin).count() > seconds;
  };
}

}  // namespace sac
