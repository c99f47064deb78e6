#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace sac {

/// Calls a function at a steady rate in a thread of its own, until it is destroyed. A call that
/// takes too long delays the next one; the beats that it missed are left out. The function must not
/// throw.
class PeriodicThread {
 public:
  /// `rate` in Hz, > 0.
  PeriodicThread(double rate, std::function<void()> function);
  ~PeriodicThread() { stop(); }
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// Returns when the function will not be called any more.
  void stop();

 private:
  void run(double rate);

  std::function<void()> function_;
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

/// Seconds of a clock that never jumps.
double steadySeconds();

}  // namespace sac
