#include "spherical_actuator_calibration/drivers/coil_driver.hpp"

#include <algorithm>
#include <chrono>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"

namespace sac {
namespace {

/// A loop that was held up must not make up for it with one large step [s].
constexpr double kLongestStep = 0.05;

std::string lostReason(const std::string& error) {
  return "the link is lost: " + error;
}

}  // namespace

CoilDriver::CoilDriver(const CurrentAmplifierOptions& options,
                       std::size_t coils,
                       ModbusTransport& transport)
    : options_(options),
      transport_(transport),
      amplifier_(options, coils, transport),
      limiter_(options.limits, coils),
      supervisor_(options.supervision, coils) {}

CoilDriver::Beat CoilDriver::beat(double now) {
  if (!link_.mayTry(now)) {
    forget();
    return {std::nullopt, lostReason(link_.lastError()), true};
  }
  try {
    allowOneBeat();
    if (!link_.isUp()) {
      connect();
    }
    Beat result = exchange(now);
    link_.success();
    return result;
  } catch (const TransportError& error) {
    fail();
    link_.failure(now, error.what());
    return {std::nullopt, lostReason(error.what()), true};
  } catch (const Error& error) {
    fail();
    return {std::nullopt, error.what(), true};
  }
}

// What was commanded before the link was lost is void, and zero is the first that is written.
void CoilDriver::connect() {
  forget();
  transport_.open();
  setZero();
}

CoilDriver::Beat CoilDriver::exchange(double begin) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  // An answer may take as long as a command is in force.
  const auto now = [&] {
    return begin + std::chrono::duration<double>(Clock::now() - began).count();
  };
  Beat result;
  if (amplifier_.isTripped()) {
    forget();
    setZero();
    result.zero_reason = "the amplifier has tripped";
    result.fault = true;
  } else {
    follow(now(), result);
  }
  last_beat_ = begin;
  const double reading_began = now();
  result.measured = measure(reading_began);
  result.reading_time = now() - reading_began;
  return result;
}

void CoilDriver::follow(double now, Beat& result) {
  const double elapsed = std::min(now - last_beat_.value_or(now), kLongestStep);
  const std::optional<Eigen::VectorXd> command = supervisor_.command(now);
  if (command && is_measured_) {
    supervisor_.setting(limiter_.follow(*command, elapsed));
    amplifier_.write(limiter_.setpoints(), OutputStages::kOn, heartbeat());
    return;
  }
  result.zero_reason = command ? "no current was measured yet" : supervisor_.zeroReason(now);
  result.fault = !supervisor_.fault().empty();
  supervisor_.setting(limiter_.stop());
  amplifier_.write(limiter_.setpoints(), OutputStages::kOff, heartbeat());
}

Heartbeat CoilDriver::heartbeat() const {
  return is_measured_ && supervisor_.mayBeat() ? Heartbeat::kGiven : Heartbeat::kWithheld;
}

Eigen::VectorXd CoilDriver::measure(double now) {
  Eigen::VectorXd measured = amplifier_.read();
  supervisor_.observe(measured, now);
  is_measured_ = true;
  return measured;
}

void CoilDriver::forget() {
  supervisor_.forget();
  supervisor_.setting(limiter_.stop());
}

void CoilDriver::fail() {
  is_measured_ = false;
  forget();
  tryToDisable();
}

void CoilDriver::setZero() {
  amplifier_.switchOff();
  amplifier_.zero();
}

// Two ways to zero, each by a link of its own if need be: an amplifier that cannot answer the first
// request any more may still take the second. Should both fail, connect() begins with zero, and
// until then the amplifier's own watchdog must act. Returns why one failed.
std::string CoilDriver::tryToDisable() {
  std::string failure;
  for (const auto way : {&CurrentAmplifier::switchOff, &CurrentAmplifier::zero}) {
    try {
      allowOneBeat();
      transport_.open();
      (amplifier_.*way)();
    } catch (const Error& error) {
      failure = error.what();
      transport_.close();
    }
  }
  return failure;
}

std::string CoilDriver::stop(double now) {
  supervisor_.close();
  forget();
  std::string failure = tryToDisable();
  try {
    allowOneBeat();
    transport_.open();
    measure(now);
  } catch (const Error& error) {
    transport_.close();
    return error.what();
  }
  return failure.empty() ? supervisor_.unconfirmedReason() : failure;
}

}  // namespace sac
