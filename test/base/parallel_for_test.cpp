#include "spherical_actuator_calibration/base/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

TEST(ParallelFor, CallsEachOnce) {
  for (const unsigned threads : {0U, 1U, 4U}) {
    std::vector<int> calls(1000);
    std::atomic<bool> strangers{false};
    parallelFor(calls.size(), threads, [&](unsigned worker, std::size_t n) {
      ++calls[n];
      strangers = strangers || worker >= std::max(1U, threads);
    });
    EXPECT_EQ(calls, std::vector<int>(1000, 1)) << threads;
    EXPECT_FALSE(strangers) << threads;
  }
  parallelFor(0, 4, [](unsigned, std::size_t) { FAIL(); });
}

TEST(ParallelFor, EndsWithTheFirstFailure) {
  std::atomic<int> calls{0};
  const auto work = [&calls](unsigned, std::size_t n) {
    ++calls;
    if (n == 3) {
      throw DataError("the fourth");
    }
  };
  EXPECT_THROW(parallelFor(1'000'000, 2, work), DataError);
  EXPECT_LT(calls, 1'000'000);
  calls = 0;
  EXPECT_THROW(parallelFor(5, 1, work), DataError);
  EXPECT_EQ(calls, 4);
}

}  // namespace
}  // namespace sac
