#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace sac {

/// Calls a function at a steady rate in a thread of its own, until it is destroyed, and sooner when
/// it is woken. A call that takes too long delays the next one; the beats that it missed are left
/// out. The function must not throw.
class PeriodicThread {
 public:
  /// `rate` in Hz, > 0.
  PeriodicThread(double rate, std::function<void()> function);
  ~PeriodicThread() { stop(); }
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// The next call begins at once, or half a period after the last one began, whichever is later;
  /// so there are at most twice as many as `rate` says. Whoever wakes it does so again, perhaps a
  /// little late: after a call that was woken the next one waits one and a half periods for that,
  /// and from there on the period counts. For any thread.
  void wake();

  /// Returns when the function will not be called any more; not to be called by the function.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;

  void run(Clock::duration period);
  /// Until the next call is due, or the end. Returns when it was due.
  Clock::time_point waitForNext(Clock::time_point begin,
                                Clock::time_point next,
                                Clock::duration period,
                                std::unique_lock<std::mutex>& lock);

  std::function<void()> function_;
  std::mutex mutex_;  ///< of what follows, down to stopped_
  std::condition_variable changed_;
  bool woken_ = false;
  bool stopped_ = false;
  std::thread thread_;
};

/// Seconds of a clock that never jumps.
double steadySeconds();

}  // namespace sac
