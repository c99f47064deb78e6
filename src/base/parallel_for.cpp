#include "spherical_actuator_calibration/base/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sac {

void parallelFor(std::size_t count,
                 unsigned threads,
                 const std::function<void(unsigned worker, std::size_t n)>& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // of the failure
  std::exception_ptr failure;
  const auto run = [&](unsigned worker) {
    for (std::size_t n = next++; n < count; n = next++) {
      try {
        work(worker, n);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        failure = failure ? failure : std::current_exception();
        next = count;
        return;
      }
    }
  };
  std::vector<std::thread> others;
  const auto most = static_cast<unsigned>(std::min<std::size_t>(std::max(1U, threads), count));
  for (unsigned worker = 1; worker < most; ++worker) {
    others.emplace_back(run, worker);
  }
  run(0);
  for (std::thread& other : others) {
    other.join();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace sac
