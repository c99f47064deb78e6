#include "spherical_actuator_calibration/drivers/current_supervisor.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/drivers/current_limiter.hpp"

namespace sac {
namespace {

/// More than clocks of a computer drift apart between two commands [s].
constexpr double kClockJump = 0.05;

/// An amplifier that deviated so often, or again so soon [s], goes on: somebody must look at it.
constexpr int kMostFaults = 3;
constexpr double kDeviatesAgain = 60.0;

/// Watchdogs of amplifiers take longer from the last heartbeat on [s].
constexpr double kOwnZero = 0.2;

/// A link that is lost again so soon after it was lost with current is so because of it [s].
constexpr double kLostAgain = 3.0;

/// Zeros that confirm that there is no current, and how long they last at least [s].
constexpr int kConfirmingZeros = 5;
constexpr double kConfirmingTime = 0.3;

/// Current of an honest amplifier flows no longer after zero was set [s].
constexpr double kLongestFade = 0.28;

/// Whoever goes on commanding what another one owns gets it only after so long a silence: a flood
/// may be the reason why the owner is not heard [s].
constexpr double kContestedSilence = 5.0;

/// An amplifier that trips so often within so long [s] does so again.
constexpr std::size_t kMostTrips = 3;
constexpr double kTrippedAgain = 3.0;

std::string withTwoDigits(double value) {
  return format("%.2f", value);
}

}  // namespace

void validate(const SupervisorLimits& limits) {
  requireInRange("watchdog", limits.watchdog, ValueRange::closed(0.01, 1.0, "s"));
  requireInRange("clock_skew", limits.clock_skew, ValueRange::closed(0.0, 1.0, "s"));
  requireInRange(
      "deviation.tolerance", limits.deviation, ValueRange{0.0, 1000.0, "A", true, false});
  requireInRange("deviation.beats", limits.deviating_beats, ValueRange::closed(1.0, 1e5));
}

CurrentSupervisor::CurrentSupervisor(const SupervisorLimits& limits, std::size_t coils)
    : limits_(limits),
      coils_(coils),
      comparison_(coils, limits.deviation, limits.deviating_beats, limits.beat_period),
      strays_(coils, limits.deviation) {
  validate(limits);
}

std::string CurrentSupervisor::offer(const CoilCommand& command, const Instant& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  noticeClockJump(now);
  std::string reason = refusal(command, now);
  if (isOwner(command)) {
    owner_heard_at_ = now.steady;
  } else if (isOwnedByAnother(command, now.steady)) {
    contested_at_ = now.steady;
  }
  if (!reason.empty()) {
    return reason;
  }
  const double age = std::max(now.wall - *command.stamp, 0.0);
  command_ = command.currents;
  was_commanded_ = true;
  owner_ = command.caller;
  owner_connection_ = command.connection;
  owner_heard_at_ = now.steady;
  last_stamp_ = command.stamp;
  zero_commanded_ = command.currents.isZero(0.0);
  waits_for_current_ = waits_for_current_ && (zero_commanded_ || !fault_.empty());
  expires_at_ = now.steady + limits_.watchdog - age;
  return {};
}

// Whoever sets the wall clock back must not lock the commander out until its stamps have caught up.
void CurrentSupervisor::noticeClockJump(const Instant& now) {
  const double offset = now.wall - now.steady;
  if (wall_offset_ && std::abs(offset - *wall_offset_) > kClockJump) {
    last_stamp_.reset();
  }
  wall_offset_ = offset;
}

std::string CurrentSupervisor::refusal(const CoilCommand& command, const Instant& now) const {
  if (closed_) {
    return "The driver ends.";
  }
  if (command.caller.empty()) {
    return "A command without the name of its sender does not count: publish it as a ROS node, "
           "which gives its own.";
  }
  const std::string who = "The command of " + command.caller + " ";
  std::string defect = commandDefect(command.currents, coils_);
  if (!defect.empty()) {
    return defect + " It came from " + command.caller + ".";
  }
  if (!command.stamp) {
    return who + "has no stamp: it may be of any time. Stamp commands by the wall clock.";
  }
  const double age = now.wall - *command.stamp;
  if (!(age <= limits_.watchdog)) {
    return who + "is " + withTwoDigits(age) +
           " s old by the wall clock, which alone counts; a simulated one or a recording drives no "
           "coils.";
  }
  if (age < -limits_.clock_skew) {
    return who + "is stamped " + withTwoDigits(-age) +
           " s ahead of the wall clock: the clocks differ.";
  }
  if (isOwnedByAnother(command, now.steady)) {
    return who + "does not count: " + (command.caller == owner_ ? "another " : "") + owner_ +
           " commands the coils, until nothing has come from there for " +
           withTwoDigits(limits_.watchdog) + " s, or " + withTwoDigits(kContestedSilence) +
           " s where others go on commanding.";
  }
  if (last_stamp_ && *command.stamp <= *last_stamp_) {
    return who + "is not newer than the one before.";
  }
  return {};
}

// The owner's commands may come too late to count, behind a flood of others: coils without current
// are safe, and those of somebody else's are not.
bool CurrentSupervisor::isOwnedByAnother(const CoilCommand& command, double steady) const {
  const bool is_contested = contested_at_ && steady - *contested_at_ <= limits_.watchdog;
  // One of the same name may be the owner itself, whose connection was lost.
  const bool is_namesake = command.caller == owner_;
  const double silence = is_contested && !is_namesake ? kContestedSilence : limits_.watchdog;
  return !isOwner(command) && !owner_.empty() &&
         steady <= std::max(expires_at_, owner_heard_at_ + silence);
}

std::optional<Eigen::VectorXd> CurrentSupervisor::command(double steady) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool may_flow = isInForce(steady) && fault_.empty() && !closed_;
  return may_flow ? command_ : std::nullopt;
}

std::optional<double> CurrentSupervisor::givenAt(double steady) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return isInForce(steady) ? std::optional<double>(expires_at_ - limits_.watchdog) : std::nullopt;
}

std::string CurrentSupervisor::zeroReason(double steady) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!fault_.empty()) {
    return fault_;
  }
  if (closed_) {
    return "the driver ends";
  }
  if (isInForce(steady)) {
    return {};
  }
  if (isFresh(steady)) {
    return "nothing but zero was commanded since the error";
  }
  return was_commanded_ ? "no fresh command" : "no command has come";
}

void CurrentSupervisor::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  command_.reset();
  was_commanded_ = false;
}

void CurrentSupervisor::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
}

void CurrentSupervisor::setting(const Eigen::VectorXd& setpoints, bool stages_on) {
  const std::lock_guard<std::mutex> lock(mutex_);
  comparison_.setting(setpoints, stages_on);
  strays_.setting(setpoints);
  if (!setpoints.isZero(0.0)) {
    zeros_ = 0;
    zero_confirmed_ = false;
    was_set_ = true;
  }
}

void CurrentSupervisor::beating(double steady) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fed_at_ = steady;
}

void CurrentSupervisor::observe(const Eigen::VectorXd& measured, double begin, double end) {
  const std::lock_guard<std::mutex> lock(mutex_);
  measured_ = measured;
  noticeFlow(begin);
  flowed_ = flows();
  countZeros(begin);
  const std::optional<std::size_t> stray = strays_.observe(measured, begin);
  std::optional<std::size_t> deviating = comparison_.observe(measured, begin, end);
  if (!deviating) {
    deviating = stray;
  }
  if (deviating && (fault_.empty() || is_loss_)) {
    failByDeviation(*deviating, end);
    return;
  }
  if (!fault_.empty()) {
    watchZero(end);
    endFault(end);
  }
}

void CurrentSupervisor::lose(double steady) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool flowed = flowed_;
  flowed_ = false;
  if (comparison_.setpoints().isZero(0.0) && !flowed) {
    return;
  }
  const bool is_again = lost_at_ && steady - *lost_at_ <= kLostAgain;
  lost_at_ = steady;
  if (is_again && fault_.empty()) {
    fail("the amplifier did not answer in time, or not at all, twice within " +
         withTwoDigits(kLostAgain) +
         " s, each time while there was current. Command zero, and look after its link and "
         "its supply; link/response_timeout is the time that it has");
    is_loss_ = true;
  }
}

void CurrentSupervisor::trip(double steady) {
  const std::lock_guard<std::mutex> lock(mutex_);
  trips_.push_back(steady);
  while (steady - trips_.front() > kTrippedAgain) {
    trips_.pop_front();
  }
  if (trips_.size() >= kMostTrips && fault_.empty()) {
    fail("the amplifier has tripped " + std::to_string(trips_.size()) + " times within " +
         withTwoDigits(kTrippedAgain) + " s. Command zero, and look why it trips");
    is_loss_ = true;
    trips_.clear();
  }
}

bool CurrentSupervisor::flows() const {
  return measured_ && measured_->cwiseAbs().maxCoeff() > limits_.deviation;
}

// Two measurements in a row: one that strays is noise.
void CurrentSupervisor::noticeFlow(double steady) {
  if (!comparison_.setpoints().isZero(0.0)) {
    zero_set_at_.reset();
    return;
  }
  zero_set_at_ = zero_set_at_.value_or(steady);
  const bool flows_on = flowed_ && flows();
  outlasted_ = outlasted_ || (closed_ && flows_on && steady - *zero_set_at_ > kLongestFade);
}

void CurrentSupervisor::countZeros(double steady) {
  zeros_ = flows() || !comparison_.setpoints().isZero(0.0) ? 0 : zeros_ + 1;
  if (zeros_ == 1) {
    zero_since_ = steady;
  }
  // Current that flows though zero is set is no longer confirmed to be zero; nor is one that only
  // passes it.
  zero_confirmed_ =
      zeros_ >= kConfirmingZeros && steady - zero_since_ >= kConfirmingTime && !outlasted_;
}

bool CurrentSupervisor::mayBeat() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool is_quiet = was_set_ || (measured_ && !flows());
  const bool is_right = fault_.empty() || (is_loss_ && isZeroNow());
  return is_right && is_quiet && !comparison_.isSuspicious();
}

bool CurrentSupervisor::mayGoOnBeating(double steady) const {
  if (!mayBeat()) {
    return false;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  return steady - fed_at_ <= kOwnZero;
}

void CurrentSupervisor::fail(const std::string& reason) {
  zero_beats_ = 0;
  obeyed_ = false;
  zero_commanded_ = false;
  is_loss_ = false;
  waits_for_current_ = true;
  fault_ = reason;
}

void CurrentSupervisor::failByDeviation(std::size_t coil, double steady) {
  ++faults_;
  is_repeated_ = failed_at_ && steady - *failed_at_ <= kDeviatesAgain;
  failed_at_ = steady;
  fail(deviation(coil, (*measured_)[static_cast<Eigen::Index>(coil)]));
}

std::string CurrentSupervisor::deviation(std::size_t coil, double measured) const {
  return "coil " + std::to_string(numberOf(coil)) + " carries " + withTwoDigits(measured) +
         " A where " + withTwoDigits(comparison_.setpoints()[static_cast<Eigen::Index>(coil)]) +
         " A are set: the amplifier does not do what it acknowledges. Its heartbeat is withheld. "
         "Switch it off, look after it and its wires, then start the driver anew";
}

void CurrentSupervisor::watchZero(double steady) {
  if (!isZeroNow()) {
    zero_beats_ = 0;
    obeyed_ = false;
    return;
  }
  ++zero_beats_;
  zero_beats_since_ = zero_beats_ == 1 ? steady : zero_beats_since_;
  obeyed_ = obeyed_ || (zero_beats_ == 1 && steady - fed_at_ <= kOwnZero);
}

// Whoever wants current must first have seen that there is a fault, and say so by a zero: a command
// that goes on through it may be given blindly.
void CurrentSupervisor::endFault(double steady) {
  const bool is_bearable = is_loss_ || (obeyed_ && faults_ < kMostFaults && !is_repeated_);
  // Beats may come faster than they usually do: the time that these take counts, too, to half a
  // beat.
  const double least = (limits_.deviating_beats - 1.5) * limits_.beat_period;
  const bool is_zero_long_enough =
      zero_beats_ >= limits_.deviating_beats && steady - zero_beats_since_ >= least;
  if (is_bearable && zero_commanded_ && is_zero_long_enough) {
    fault_.clear();
    strays_.forgive();
    comparison_.forgive();
  }
}

std::string CurrentSupervisor::owner(double steady) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return steady <= expires_at_ ? owner_ : std::string();
}

std::string CurrentSupervisor::fault() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_;
}

int CurrentSupervisor::faults() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return faults_;
}

bool CurrentSupervisor::isZeroConfirmed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return zero_confirmed_;
}

std::string CurrentSupervisor::unconfirmedReason() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (zero_confirmed_) {
    return {};
  }
  if (!measured_) {
    return "no current was ever measured";
  }
  if (outlasted_) {
    return "current flowed on for more than " + withTwoDigits(kLongestFade) +
           " s after zero was set, until the amplifier's own watchdog may have ended it";
  }
  const double largest = measured_->cwiseAbs().maxCoeff();
  return "the last measurement has a current of up to " + withTwoDigits(largest) +
         " A, and no zeros for " + withTwoDigits(kConfirmingTime) + " s came after it";
}

}  // namespace sac
