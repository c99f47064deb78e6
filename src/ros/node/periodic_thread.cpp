#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

#include <chrono>
#include <utility>

namespace sac {

using Clock = std::chrono::steady_clock;

PeriodicThread::PeriodicThread(double rate, std::function<void()> function)
    : function_(std::move(function)), thread_([this, rate] { run(rate); }) {}

void PeriodicThread::stop() {
  stopped_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
}

void PeriodicThread::run(double rate) {
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate));
  Clock::time_point next = Clock::now();
  while (!stopped_) {
    function_();
    next += period;
    const Clock::time_point now = Clock::now();
    if (next < now) {
      next = now;
    }
    std::this_thread::sleep_until(next);
  }
}

double steadySeconds() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace sac
