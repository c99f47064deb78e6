#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/drivers/current_amplifier.hpp"
#include "spherical_actuator_calibration/drivers/current_limiter.hpp"
#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"
#include "spherical_actuator_calibration/drivers/link_supervisor.hpp"

namespace sac {

/// Drives the coils of one actuator, beat by beat. Currents are zero unless there is every reason
/// that they should not be: without a command that counts (see CurrentSupervisor), after a lost
/// link, after a trip, after an error, at the start and at the end, and where the beat before could
/// not measure them: then the heartbeat is withheld, too. A command that was given before any of
/// these is forgotten. All requests of a beat together have the response timeout.
///
/// Times are seconds of a steady clock of the caller. Thread-safe are only offer() and
/// supervisor().
class CoilDriver {
 public:
  /// What one beat did.
  struct Beat {
    std::optional<Eigen::VectorXd> measured;  ///< currents [A]; nothing when they could not be read
    std::string zero_reason;  ///< why zero is set; empty while a command is followed
    bool fault = false;       ///< the device is the reason, not the want of commands
    /// The middle of the request that read the currents [s].
    double measured_at = 0.0;
    /// The middle of the request that wrote the setpoints, those of limiter() [s].
    std::optional<double> set_at = std::nullopt;
    /// Of a command when it was set for the first time, since its stamp [s].
    std::optional<double> command_age = std::nullopt;
  };

  /// Keeps a reference to the transport, which may be closed. Throws ConfigError when the options
  /// are not valid.
  CoilDriver(const CurrentAmplifierOptions& options, std::size_t coils, ModbusTransport& transport);

  /// Takes a command, or tells why it is refused: see CurrentSupervisor::offer().
  std::string offer(const CoilCommand& command, const Instant& now) {
    return supervisor_.offer(command, now);
  }

  /// One beat: opens a lost link when it is time to, writes setpoints, reads currents. Beats may
  /// come at any time: what is judged is judged by the time that passes. What devices
  /// and links do wrong ends in zero currents and `zero_reason`, never in an exception.
  Beat beat(double now);

  /// Zero at once and for good. The heartbeat goes on after that, so that an amplifier which has
  /// not taken the zero shows its current, until it is told, rather than that its watchdog ends it
  /// as if it had obeyed. Returns nothing when the amplifier took it and zero is confirmed
  /// (CurrentSupervisor::isZeroConfirmed()), otherwise why not: then it is worth another call, as
  /// currents need a moment to fade, and a confirmation needs several.
  std::string stop(double now);

  /// After stop(), until the program has ended: measures once more, without a heartbeat. Returns
  /// why the currents are not zero any more, once they are not, and sets zero again; nothing while
  /// they are, as far as it can be measured.
  std::string watch(double now);

  const LinkSupervisor& link() const { return link_; }
  const CurrentLimiter& limiter() const { return limiter_; }
  const CurrentSupervisor& supervisor() const { return supervisor_; }

 private:
  class BeatClock;

  void connect();
  Beat exchange(const BeatClock& clock);
  /// Sets what is to be set, and measures. Returns whether the amplifier says that it has tripped.
  bool follow(const BeatClock& clock, Beat& result);
  void rememberBeatTime(const BeatClock& clock);
  Heartbeat heartbeat(double now);
  void goOnBeating(double now);
  void observe(const AmplifierReading& reading, const BeatClock& clock, Beat& result);
  void forget();
  void fail(double now);
  void setZero();
  void allowOneBeat() { transport_.allow(options_.link.response_timeout); }
  /// What became of both ways to zero.
  struct Disabling {
    std::string failure;    ///< why one failed; empty: none did
    bool is_taken = false;  ///< the amplifier has acknowledged one
  };
  Disabling tryToDisable();
  /// Returns why not.
  std::string tryTo(void (CurrentAmplifier::*way)());

  CurrentAmplifierOptions options_;
  ModbusTransport& transport_;
  CurrentAmplifier amplifier_;
  CurrentLimiter limiter_;
  CurrentSupervisor supervisor_;
  LinkSupervisor link_;
  std::optional<double> last_beat_;
  double beat_time_ = 0.0;               ///< of the slowest beat lately [s]
  double answered_at_ = 0.0;             ///< begin of the last beat that was answered [s]
  std::optional<double> last_given_at_;  ///< the last command that was set, by the steady clock [s]
  bool is_measured_ = false;             ///< currents were, by the last beat
  bool was_tripped_ = false;             ///< the amplifier, likewise
};

}  // namespace sac
