#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

#include <algorithm>
#include <utility>

#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

namespace sac {

PeriodicThread::PeriodicThread(double rate, std::function<void()> function)
    : function_(std::move(function)) {
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate));
  thread_ = std::thread([this, period] { run(period); });
}

void PeriodicThread::wake() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    woken_ = true;
  }
  changed_.notify_one();
}

void PeriodicThread::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void PeriodicThread::run(Clock::duration period) {
  goBeforeOtherThreads();
  std::unique_lock<std::mutex> lock(mutex_);
  Clock::time_point next = Clock::now() + period;
  while (!stopped_) {
    const Clock::time_point begin = Clock::now();
    // What wakes it from now on may have come too late for this call.
    woken_ = false;
    lock.unlock();
    function_();
    lock.lock();
    next = waitForNext(begin, next, period, lock) + period;
  }
}

PeriodicThread::Clock::time_point PeriodicThread::waitForNext(Clock::time_point begin,
                                                              Clock::time_point next,
                                                              Clock::duration period,
                                                              std::unique_lock<std::mutex>& lock) {
  const Clock::time_point due = std::max(next, Clock::now());
  const bool is_early =
      changed_.wait_until(lock, due, [this] { return stopped_ || woken_; }) && !stopped_;
  if (!is_early) {
    return due;
  }
  const Clock::time_point earliest = std::min(begin + period / 2, due);
  changed_.wait_until(lock, earliest, [this] { return stopped_; });
  return Clock::now() + period / 2;
}

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace sac
