#include "spherical_actuator_calibration/drivers/coil_driver.hpp"

#include <algorithm>
#include <chrono>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"

namespace sac {
namespace {

/// A loop that was held up must not make up for it with one large step [s].
constexpr double kLongestStep = 0.05;
constexpr double kForgivenBeatTime = 0.05;  // [s] in a second

std::string lostReason(const std::string& error) {
  return "the link is lost: " + error;
}

}  // namespace

/// The time in a beat that began at a time of the caller's clock: an answer may take as long as a
/// command is in force.
class CoilDriver::BeatClock {
 public:
  explicit BeatClock(double begin) : begin_(begin) {}

  double begin() const { return begin_; }
  double now() const {
    return begin_ + std::chrono::duration<double>(Clock::now() - began_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;

  double begin_;
  Clock::time_point began_ = Clock::now();
};

CoilDriver::CoilDriver(const CurrentAmplifierOptions& options,
                       std::size_t coils,
                       ModbusTransport& transport)
    : options_(options),
      transport_(transport),
      amplifier_(options, coils, transport),
      limiter_(options.limits, coils),
      supervisor_(options.supervision, coils) {}

CoilDriver::Beat CoilDriver::beat(double now) {
  const BeatClock clock(now);
  if (!link_.mayTry(now)) {
    forget();
    return {std::nullopt, lostReason(link_.lastError()), true};
  }
  try {
    allowOneBeat();
    if (!link_.isUp()) {
      connect();
    }
    Beat result = exchange(clock);
    rememberBeatTime(clock);
    link_.success();
    return result;
  } catch (const TransportError& error) {
    fail(clock.now());
    // What has failed took its time: the wait begins now.
    link_.failure(clock.now(), error.what());
    return {std::nullopt, lostReason(error.what()), true};
  } catch (const Error& error) {
    fail(clock.now());
    return {std::nullopt, error.what(), true};
  }
}

// What was commanded before the link was lost is void, and zero is the first that is written.
void CoilDriver::connect() {
  forget();
  transport_.open();
  setZero();
}

CoilDriver::Beat CoilDriver::exchange(const BeatClock& clock) {
  Beat result;
  bool is_tripped = !amplifier_.tellsTripsByReadings() && amplifier_.isTripped();
  if (!is_tripped) {
    is_tripped = follow(clock, result);
  }
  if (is_tripped && !was_tripped_) {
    supervisor_.trip(clock.now());
  }
  was_tripped_ = is_tripped;
  if (is_tripped) {
    forget();
    setZero();
    last_beat_ = clock.begin();
    result.zero_reason = "the amplifier has tripped";
    result.fault = true;
    observe(amplifier_.read(), clock, result);
  }
  return result;
}

bool CoilDriver::follow(const BeatClock& clock, Beat& result) {
  const double now = clock.now();
  const double elapsed = std::min(now - last_beat_.value_or(now), kLongestStep);
  last_beat_ = clock.begin();
  const std::optional<double> given_at = supervisor_.givenAt(now);
  // What is set now flows until the next beat sets something else: slow answers take from the time
  // of a command, they do not add to it.
  const double until = now + beat_time_;
  const std::optional<Eigen::VectorXd> command = supervisor_.command(until);
  const bool may_flow = command && is_measured_;
  if (may_flow) {
    if (given_at && given_at != last_given_at_) {
      result.command_age = now - *given_at;
      last_given_at_ = given_at;
    }
    limiter_.follow(*command, elapsed);
  } else {
    result.zero_reason = command ? "no current was measured yet" : supervisor_.zeroReason(until);
    result.fault = !supervisor_.fault().empty();
    limiter_.stop();
  }
  supervisor_.setting(limiter_.setpoints(), may_flow);
  const OutputStages stages = may_flow ? OutputStages::kOn : OutputStages::kOff;
  const AmplifierReading reading =
      amplifier_.exchange(limiter_.setpoints(), stages, heartbeat(now));
  result.set_at = clock.now() - reading.since_set;
  observe(reading, clock, result);
  return reading.tripped;
}

// One slow answer is seldom the last one.
void CoilDriver::rememberBeatTime(const BeatClock& clock) {
  const double forgotten = kForgivenBeatTime * (clock.begin() - answered_at_);
  const double taken = clock.now() - clock.begin();
  beat_time_ = std::max(taken, beat_time_ - std::max(forgotten, 0.0));
  answered_at_ = clock.begin();
}

Heartbeat CoilDriver::heartbeat(double now) {
  if (!is_measured_ || !supervisor_.mayBeat()) {
    return Heartbeat::kWithheld;
  }
  supervisor_.beating(now);
  return Heartbeat::kGiven;
}

void CoilDriver::goOnBeating(double now) {
  if (!was_tripped_ && is_measured_ && supervisor_.mayGoOnBeating(now)) {
    supervisor_.beating(now);
    amplifier_.feed();
  }
}

void CoilDriver::observe(const AmplifierReading& reading, const BeatClock& clock, Beat& result) {
  const double end = clock.now();
  supervisor_.observe(reading.currents, end - reading.duration, end);
  is_measured_ = true;
  result.measured = reading.currents;
  result.measured_at = end - 0.5 * reading.duration;
}

void CoilDriver::forget() {
  supervisor_.forget();
  supervisor_.setting(limiter_.stop(), false);
}

void CoilDriver::fail(double now) {
  is_measured_ = false;
  supervisor_.lose(now);
  forget();
  tryToDisable();
}

void CoilDriver::setZero() {
  amplifier_.switchOff();
  amplifier_.zero();
}

// Two ways to zero, each by a link of its own if need be: an amplifier that cannot answer the first
// request any more may still take the second. Should both fail, connect() begins with zero, and
// until then the amplifier's own watchdog must act.
CoilDriver::Disabling CoilDriver::tryToDisable() {
  Disabling result;
  for (const auto way : {&CurrentAmplifier::switchOff, &CurrentAmplifier::zero}) {
    allowOneBeat();
    const std::string reason = tryTo(way);
    // The link may have been dead already: a new one has what is left of the time.
    const std::string again = reason.empty() ? reason : tryTo(way);
    result.failure = again.empty() ? result.failure : reason;
    const bool is_way = way == &CurrentAmplifier::zero || options_.enable_address;
    result.is_taken = result.is_taken || (is_way && again.empty());
  }
  return result;
}

std::string CoilDriver::tryTo(void (CurrentAmplifier::*way)()) {
  try {
    transport_.open();
    (amplifier_.*way)();
    return {};
  } catch (const Error& error) {
    transport_.close();
    return error.what();
  }
}

std::string CoilDriver::stop(double now) {
  const BeatClock clock(now);
  supervisor_.close();
  forget();
  const Disabling disabling = tryToDisable();
  if (!disabling.is_taken) {
    // What is measured now to be zero may be so by the amplifier's watchdog alone.
    return disabling.failure;
  }
  try {
    allowOneBeat();
    transport_.open();
    if (disabling.failure.empty()) {
      goOnBeating(clock.now());
    }
    const AmplifierReading reading = amplifier_.read();
    was_tripped_ = was_tripped_ || reading.tripped;
    Beat last;
    observe(reading, clock, last);
  } catch (const Error& error) {
    transport_.close();
    return error.what();
  }
  return disabling.failure.empty() ? supervisor_.unconfirmedReason() : disabling.failure;
}

// An amplifier that has gone in the meantime had no current when it was heard last.
std::string CoilDriver::watch(double now) {
  const BeatClock clock(now);
  try {
    allowOneBeat();
    transport_.open();
    Beat last;
    observe(amplifier_.read(), clock, last);
  } catch (const Error&) {
    transport_.close();
  }
  std::string reason = supervisor_.unconfirmedReason();
  if (!reason.empty()) {
    tryToDisable();
  }
  return reason;
}

}  // namespace sac
