#include "spherical_actuator_calibration/drivers/coil_driver.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"

namespace sac {
namespace {

/// A loop that was held up must not make up for it with one large step [s].
constexpr double kLongestStep = 0.05;

constexpr int kStopAttempts = 3;

std::string lostReason(const std::string& error) {
  return "the link is lost: " + error;
}

}  // namespace

CoilDriver::CoilDriver(const CurrentAmplifierOptions& options,
                       std::size_t coils,
                       ModbusTransport& transport)
    : options_(options),
      coils_(coils),
      transport_(transport),
      amplifier_(options, coils, transport),
      limiter_(options.limits, coils) {}

std::string CoilDriver::command(const Eigen::VectorXd& currents, double now) {
  std::string defect = commandDefect(currents, coils_);
  if (defect.empty()) {
    command_ = currents;
    commanded_at_ = now;
  }
  return defect;
}

CoilDriver::Beat CoilDriver::beat(double now) {
  if (!link_.mayTry(now)) {
    forget();
    return {std::nullopt, lostReason(link_.lastError()), true};
  }
  try {
    if (!link_.isUp()) {
      connect();
    }
    Beat result = exchange(now);
    link_.success();
    return result;
  } catch (const TransportError& error) {
    forget();
    tryToDisable();
    link_.failure(now, error.what());
    return {std::nullopt, lostReason(error.what()), true};
  } catch (const Error& error) {
    forget();
    tryToDisable();
    return {std::nullopt, error.what(), true};
  }
}

// What was commanded before the link was lost is void, and zero is the first that is written.
void CoilDriver::connect() {
  forget();
  transport_.open();
  amplifier_.disable();
}

CoilDriver::Beat CoilDriver::exchange(double now) {
  Beat result;
  if (amplifier_.isTripped()) {
    forget();
    amplifier_.disable();
    result.zero_reason = "the amplifier has tripped";
    result.fault = true;
  } else {
    result.zero_reason = zeroReason(now);
    const double elapsed = std::min(now - last_beat_.value_or(now), kLongestStep);
    if (result.zero_reason.empty()) {
      amplifier_.write(limiter_.follow(*command_, elapsed), OutputStages::kOn);
    } else {
      amplifier_.write(limiter_.stop(), OutputStages::kOff);
    }
  }
  last_beat_ = now;
  result.measured = amplifier_.read();
  return result;
}

std::string CoilDriver::zeroReason(double now) const {
  if (!command_) {
    return "no command has come";
  }
  return now - commanded_at_ > options_.watchdog ? "no fresh command" : "";
}

void CoilDriver::forget() {
  command_.reset();
  limiter_.stop();
}

void CoilDriver::tryToDisable() {
  try {
    transport_.open();
    amplifier_.disable();
  } catch (const Error&) {
    // The link is lost: connect() begins with zero, and until then the amplifier's own watchdog
    // must act.
    transport_.close();
  }
}

std::string CoilDriver::stop() {
  forget();
  std::string reason;
  for (int attempt = 0; attempt < kStopAttempts; ++attempt) {
    try {
      transport_.open();
      amplifier_.disable();
      return {};
    } catch (const Error& error) {
      reason = error.what();
      transport_.close();
    }
  }
  return reason;
}

}  // namespace sac
