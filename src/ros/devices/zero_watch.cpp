#include "spherical_actuator_calibration/ros/devices/zero_watch.hpp"

#include <cstdio>
#include <exception>
#include <string>
#include <utility>

#include "spherical_actuator_calibration/ros/node/termination.hpp"

namespace sac {

ZeroWatch::ZeroWatch(std::shared_ptr<DrivenAmplifier> amplifier, double rate)
    : amplifier_(std::move(amplifier)), thread_(rate, [this] { look(); }) {}

bool ZeroWatch::end() {
  thread_.stop();
  look();
  return is_zero_;
}

void ZeroWatch::look() {
  std::string reason;
  try {
    reason = amplifier_->driver.watch(steadySeconds());
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!reason.empty() && is_zero_.exchange(false)) {
    lateEndFails();
    std::fprintf(stderr,
                 "FATAL: The currents were zero, and are no more while the driver ends: %s. Switch "
                 "the amplifier off.\n",
                 reason.c_str());
  }
}

}  // namespace sac
