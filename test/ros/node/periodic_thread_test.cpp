#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

#include <condition_variable>
#include <mutex>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

/// When a function was called [s].
class Calls {
 public:
  void note() {
    const std::lock_guard<std::mutex> lock(mutex_);
    times_.push_back(steadySeconds());
    changed_.notify_all();
  }
  /// The times of the first calls, once there are so many.
  std::vector<double> first(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return times_.size() >= count; });
    return {times_.begin(), times_.begin() + static_cast<std::ptrdiff_t>(count)};
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<double> times_;
};

TEST(PeriodicThread, BeginsAtOnceAndKeepsItsRate) {
  constexpr double kPeriod = 0.02;
  Calls calls;
  const PeriodicThread thread(1.0 / kPeriod, [&] { calls.note(); });
  const std::vector<double> times = calls.first(11);
  EXPECT_GE(times.back() - times.front(), 10.0 * kPeriod - 0.5 * kPeriod);
}

TEST(PeriodicThread, BeginsSoonerWhenItIsWokenButNoSoonerThanHalfAPeriod) {
  constexpr double kPeriod = 2.0;  // [s], so that a busy computer is not taken for the period
  Calls calls;
  PeriodicThread thread(1.0 / kPeriod, [&] { calls.note(); });
  calls.first(1);
  thread.wake();
  const std::vector<double> times = calls.first(2);
  EXPECT_GE(times[1] - times[0], 0.5 * kPeriod - 1e-3);
  EXPECT_LT(times[1] - times[0], 0.95 * kPeriod);
}

TEST(PeriodicThread, AFloodWakesItTwiceInAPeriod) {
  constexpr double kPeriod = 0.02;
  constexpr std::size_t kCalls = 21;
  Calls calls;
  PeriodicThread thread(1.0 / kPeriod, [&] {
    calls.note();
    thread.wake();
  });
  const std::vector<double> times = calls.first(kCalls);
  thread.stop();
  for (std::size_t n = 1; n < kCalls; ++n) {
    EXPECT_GE(times[n] - times[n - 1], 0.5 * kPeriod - 1e-3);
  }
}

// The next command of a loop as fast as this one may come a little late.
TEST(PeriodicThread, WaitsHalfAPeriodMoreForWhatWokeIt) {
  constexpr double kPeriod = 0.4;
  Calls calls;
  PeriodicThread thread(1.0 / kPeriod, [&] { calls.note(); });
  calls.first(1);
  thread.wake();
  const std::vector<double> times = calls.first(4);
  EXPECT_GE(times[2] - times[1], 1.5 * kPeriod - 1e-3);
  EXPECT_GE(times[3] - times[1], 2.5 * kPeriod - 1e-3);
}

TEST(PeriodicThread, EndsAtOnceHoweverLongItsPeriodIs) {
  constexpr double kPeriod = 1000.0;
  Calls calls;
  PeriodicThread thread(1.0 / kPeriod, [&] { calls.note(); });
  calls.first(1);
  const double begin = steadySeconds();
  thread.stop();
  EXPECT_LT(steadySeconds() - begin, 0.01 * kPeriod);
  thread.wake();
  EXPECT_EQ(calls.first(1).size(), 1U);
}

}  // namespace
}  // namespace sac
