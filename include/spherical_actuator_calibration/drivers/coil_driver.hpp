#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"
#include "spherical_actuator_calibration/drivers/current_limiter.hpp"
#include "spherical_actuator_calibration/drivers/link_supervisor.hpp"

namespace sac {

/// Drives the coils of one actuator, beat by beat. Currents are zero unless there is every reason
/// that they should not be: without a fresh command, after a lost link, after a trip, after an
/// error, at the start and at the end. A command that was given before any of these is forgotten.
///
/// Times are seconds of a steady clock of the caller. Not thread-safe.
class CoilDriver {
 public:
  /// What one beat did.
  struct Beat {
    std::optional<Eigen::VectorXd> measured;  ///< currents [A]; nothing when they could not be read
    std::string zero_reason;  ///< why the currents are zero; empty while a command is followed
    bool fault = false;       ///< the device is the reason, not the want of commands
  };

  /// Keeps a reference to the transport, which may be closed. Throws ConfigError when the options
  /// are not valid.
  CoilDriver(const CurrentAmplifierOptions& options, std::size_t coils, ModbusTransport& transport);

  /// Takes a command [A] that was given at `now`. Returns why it is refused, or nothing; a refused
  /// one changes nothing, so that the one before runs into the watchdog.
  std::string command(const Eigen::VectorXd& currents, double now);

  /// One beat: opens a lost link when it is time to, writes setpoints, reads currents. What devices
  /// and links do wrong ends in zero currents and `zero_reason`, never in an exception.
  Beat beat(double now);

  /// Zero at once and for good, with a few attempts; the reason when none succeeded.
  std::string stop();

  const LinkSupervisor& link() const { return link_; }
  const CurrentLimiter& limiter() const { return limiter_; }

 private:
  void connect();
  Beat exchange(double now);
  std::string zeroReason(double now) const;
  void forget();
  void tryToDisable();

  CurrentAmplifierOptions options_;
  std::size_t coils_;
  ModbusTransport& transport_;
  CurrentAmplifier amplifier_;
  CurrentLimiter limiter_;
  LinkSupervisor link_;
  std::optional<Eigen::VectorXd> command_;
  double commanded_at_ = 0.0;
  std::optional<double> last_beat_;
};

}  // namespace sac
