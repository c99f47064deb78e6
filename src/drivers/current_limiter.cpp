#include "spherical_actuator_calibration/drivers/current_limiter.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {

void validate(const CurrentLimits& limits) {
  const ValueRange ampere{0.0, 1000.0, "A", true, false};
  requireInRange("limits.coil", limits.coil, ampere);
  requireInRange("limits.total", limits.total, ampere);
  requireInRange("limits.slew", limits.slew, ValueRange{0.0, 1e6, "A/s", true, false});
}

std::string commandDefect(const Eigen::VectorXd& command, std::size_t coils) {
  if (static_cast<std::size_t>(command.size()) != coils) {
    return "The command has " + std::to_string(command.size()) + " currents for " +
           std::to_string(coils) + " coils.";
  }
  for (std::size_t coil = 0; coil < coils; ++coil) {
    if (!std::isfinite(command[static_cast<Eigen::Index>(coil)])) {
      return "The commanded current of coil " + std::to_string(numberOf(coil)) + " is not finite.";
    }
  }
  return {};
}

CurrentLimiter::CurrentLimiter(const CurrentLimits& limits, std::size_t coils)
    : limits_(limits), setpoints_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils))) {
  validate(limits);
}

const Eigen::VectorXd& CurrentLimiter::follow(const Eigen::VectorXd& command, double elapsed) {
  Eigen::VectorXd wanted = command.cwiseMax(-limits_.coil).cwiseMin(limits_.coil);
  const double total = wanted.cwiseAbs().sum();
  if (total > limits_.total) {
    wanted *= limits_.total / total;
  }
  constexpr double kRounding = 1e-9;  // of a sum that was scaled to the limit
  if ((wanted - command).cwiseAbs().maxCoeff() > kRounding * limits_.total) {
    ++clamped_;
  }
  const double step = limits_.slew * std::max(elapsed, 0.0);
  setpoints_ += (wanted - setpoints_).cwiseMax(-step).cwiseMin(step);
  // On the way from one pattern to another the sum can be larger than at either end.
  const double on_the_way = setpoints_.cwiseAbs().sum();
  if (on_the_way > limits_.total) {
    setpoints_ *= limits_.total / on_the_way;
  }
  return setpoints_;
}

std::string CurrentLimiter::limitsInWords() const {
  return format("limits/coil %.3g A, limits/total %.3g A", limits_.coil, limits_.total);
}

const Eigen::VectorXd& CurrentLimiter::stop() {
  setpoints_.setZero();
  return setpoints_;
}

}  // namespace sac
