#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/usual_currents.hpp"

namespace sac {

/// What coils, wires and supply bear.
struct CurrentLimits {
  double coil = kUsualCoilCurrent;    ///< largest |current| of one coil [A]
  double total = kUsualTotalCurrent;  ///< largest sum of all |currents| [A]
  double slew = 100.0;  ///< largest change of a coil's current [A/s]; a stop is not slowed by it
};

/// Throws ConfigError that names the limit and its range.
void validate(const CurrentLimits& limits);

/// Why a command of currents must not be followed: wrong length or not finite. Empty: it may.
std::string commandDefect(const Eigen::VectorXd& command, std::size_t coils);

/// Turns commanded currents into setpoints within the limits.
class CurrentLimiter {
 public:
  CurrentLimiter(const CurrentLimits& limits, std::size_t coils);

  /// Next setpoints [A], `elapsed` seconds after the last ones: each coil within its limit, all
  /// scaled down together where their sum is too large, then moved towards from the last setpoints
  /// no faster than the slew limit. `command` is without defect.
  const Eigen::VectorXd& follow(const Eigen::VectorXd& command, double elapsed);
  /// Zero at once.
  const Eigen::VectorXd& stop();

  const Eigen::VectorXd& setpoints() const { return setpoints_; }
  /// How often a command was beyond a limit of one coil or of the sum.
  std::size_t clamped() const { return clamped_; }
  /// "limits/coil 2.5 A, limits/total 8 A".
  std::string limitsInWords() const;

 private:
  CurrentLimits limits_;
  Eigen::VectorXd setpoints_;
  std::size_t clamped_ = 0;
};

}  // namespace sac
