#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/drivers/current_comparison.hpp"
#include "spherical_actuator_calibration/drivers/stray_currents.hpp"

namespace sac {

/// When currents may flow, and when what flows is not what was set.
struct SupervisorLimits {
  double watchdog = 0.25;      ///< a command holds for so long from its stamp on [s]
  double clock_skew = 0.1;     ///< the clocks of commander and driver may differ by [s]
  double deviation = 0.15;     ///< of a measured current from the one that is set, at most [A]
  int deviating_beats = 40;    ///< beyond it, of one coil, are an error: see CurrentComparison
  double beat_period = 0.005;  ///< of beats that are not slowed down [s]
};

/// Throws ConfigError that names the limit and its range.
void validate(const SupervisorLimits& limits);

/// Currents that somebody wants.
struct CoilCommand {
  std::string caller;  ///< name of who gave it
  /// When it was given, by the wall clock [s since 1970]; nothing: it does not say.
  std::optional<double> stamp;
  Eigen::VectorXd currents;  ///< [A], one per coil
  /// The same for all that come by one connection: tells two of one name apart.
  const void* connection = nullptr;
};

/// The same moment by two clocks.
struct Instant {
  double steady = 0.0;  ///< of a clock that never jumps [s]
  double wall = 0.0;    ///< since 1970 [s]; somebody may set this clock
};

/// Judges whether the coils of one actuator may have current, by what is commanded, and whether
/// they have what was set, by what is measured.
///
/// A command counts when it is well formed, stamped by the wall clock, neither old nor of the
/// future, newer than the one before, and given by the only one who commands: whoever was last
/// accepted owns the coils until the last command has run out, and nothing that does not count has
/// come from there for as long, or for 5 s where another one goes on commanding: who lives, but is
/// late, does not lose them. A command holds for the watchdog's time from its stamp on, however
/// late it arrived; a steady clock watches that. Nothing depends on a simulated clock, so that a
/// recording which is played again drives no coil.
///
/// Thread-safe: commands arrive in one thread, and are followed in another.
class CurrentSupervisor {
 public:
  /// Throws ConfigError when a limit is out of its range.
  CurrentSupervisor(const SupervisorLimits& limits, std::size_t coils);

  /// Takes a command that arrives now. Returns why it is refused, in a sentence for its sender, or
  /// nothing. A refused one tells that its sender lives, and changes nothing else: the one before
  /// runs out.
  std::string offer(const CoilCommand& command, const Instant& now);
  /// The command in force [A]; nothing when the currents must be zero, see zeroReason().
  std::optional<Eigen::VectorXd> command(double steady) const;
  /// When it was given, by its stamp, on the steady clock [s]; nothing: there is none in force.
  std::optional<double> givenAt(double steady) const;
  /// Why there is no command in force; empty when there is one.
  std::string zeroReason(double steady) const;
  /// Who commands the coils at present; empty: nobody.
  std::string owner(double steady) const;
  /// What was commanded until now is void. Who owns the coils stays.
  void forget();
  /// For good: no command is accepted any more.
  void close();

  /// These setpoints [A] go to the amplifier next, and its output stages are on or off: from now on
  /// current may flow.
  void setting(const Eigen::VectorXd& setpoints, bool stages_on = true);
  /// The heartbeat goes to the amplifier now, or is on its way for a moment.
  void beating(double steady);
  /// These currents [A] were measured between two times [s], after the last setpoints were written,
  /// and are held against what was set: see CurrentComparison.
  void observe(const Eigen::VectorXd& measured, double begin, double end);
  /// The link was lost, or the answers came too late, after what was set last, so that it was not
  /// measured. Twice within 3 s with current, set or measured, it is an error: each time there was
  /// some for as long as answers may take, and nobody saw it. It ends as the other one does,
  /// whenever zero is measured.
  void lose(double steady);
  /// The amplifier has tripped. Three times within 3 s is an error that ends as that one does: it
  /// would have current for a moment again and again.
  void trip(double steady);
  /// What flows against what was set, and what to do; empty: nothing is wrong. While it is not
  /// empty no command is followed, and the heartbeat must be withheld, so that the amplifier's own
  /// watchdog acts. It ends when zero was measured in all coils for `deviating_beats` beats in a
  /// row and for the time that these take, the first of them within 0.2 s of the last heartbeat,
  /// and the last command that was accepted since it began is zero: then it was the amplifier that
  /// obeyed, and not its watchdog that acted, after which it would have current again with the next
  /// heartbeat. The second one within a minute stays, and the third one. After one has ended there
  /// is no command in force until one wants current: those of zero would only switch the output
  /// stages on again.
  std::string fault() const;
  /// Whether the amplifier may have its heartbeat: nothing is wrong, nor likely to be; and before
  /// anything was commanded nothing flows, so that a driver that starts revives no current which
  /// the amplifier's watchdog has ended.
  bool mayBeat() const;
  /// The same at the end, when zero is set for good: and the last heartbeat is so young that no
  /// watchdog can have acted since. Current that one has ended must not be revived.
  bool mayGoOnBeating(double steady) const;
  /// How often there was one.
  int faults() const;
  /// Whether zero was measured in all coils, five times in a row and for 0.3 s at least, since
  /// anything else was set or measured: a current that alternates passes zero, too, and what was
  /// set last may be on its way for as long as an honest amplifier takes. Where current flowed for
  /// longer than that after zero was set, and after close(), it never is: only a watchdog may have
  /// ended it.
  bool isZeroConfirmed() const;
  /// In words, why it is not; empty when it is.
  std::string unconfirmedReason() const;

 private:
  std::string refusal(const CoilCommand& command, const Instant& now) const;
  bool isFresh(double steady) const { return command_.has_value() && steady <= expires_at_; }
  bool isInForce(double steady) const { return isFresh(steady) && !waits_for_current_; }
  void noticeClockJump(const Instant& now);
  bool isOwnedByAnother(const CoilCommand& command, double steady) const;
  void countZeros(double steady);
  void noticeFlow(double steady);
  bool flows() const;
  bool isZeroNow() const { return zeros_ > 0; }
  bool isOwner(const CoilCommand& command) const {
    return command.caller == owner_ && command.connection == owner_connection_;
  }
  void fail(const std::string& reason);
  void failByDeviation(std::size_t coil, double steady);
  std::string deviation(std::size_t coil, double measured) const;
  void watchZero(double steady);
  void endFault(double steady);

  const SupervisorLimits limits_;
  const std::size_t coils_;
  mutable std::mutex mutex_;  ///< of all that follows
  bool closed_ = false;
  std::optional<Eigen::VectorXd> command_;
  bool was_commanded_ = false;
  double expires_at_ = 0.0;  ///< the last command, by the steady clock
  std::string owner_;        ///< who gave it
  const void* owner_connection_ = nullptr;
  double owner_heard_at_ = 0.0;         ///< also by what did not count
  std::optional<double> contested_at_;  ///< last command of another one that was refused for it
  std::optional<double> last_stamp_;    ///< its stamp
  std::optional<double> wall_offset_;   ///< wall less steady clock, when it came
  CurrentComparison comparison_;
  std::optional<Eigen::VectorXd> measured_;
  int zeros_ = 0;            ///< measurements in a row of nothing but zero, while zero is set
  double zero_since_ = 0.0;  ///< the first of them, by the steady clock [s]
  bool zero_confirmed_ = false;
  std::optional<double> zero_set_at_;  ///< first measurement since nothing but zero is set [s]
  bool outlasted_ = false;             ///< current did what was set, after close()
  bool was_set_ = false;               ///< anything but zero
  StrayCurrents strays_;
  std::string fault_;
  bool is_loss_ = false;             ///< it is one of the link, or of trips
  int faults_ = 0;                   ///< others
  std::optional<double> failed_at_;  ///< the last one of these, by the steady clock [s]
  bool is_repeated_ = false;         ///< it came soon after one before
  bool waits_for_current_ = false;   ///< since a fault nothing but zero was commanded
  /// The last heartbeat, by the steady clock [s].
  double fed_at_ = -std::numeric_limits<double>::infinity();
  bool flowed_ = false;            ///< current was measured since the link was lost last
  std::optional<double> lost_at_;  ///< with current, by the steady clock [s]
  std::deque<double> trips_;       ///< the last ones, likewise
  bool obeyed_ = false;  ///< zero was measured before the amplifier's watchdog can have acted
  int zero_beats_ = 0;   ///< in a row, since the fault
  double zero_beats_since_ = 0.0;  ///< by the steady clock [s]
  bool zero_commanded_ = false;    ///< by the last command that was accepted since the fault
};

}  // namespace sac
