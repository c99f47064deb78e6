#include "spherical_actuator_calibration/ros/node/memory_limit.hpp"

#include <cerrno>
#include <fstream>
#include <limits>
#include <string>
#include <system_error>

#include <sys/resource.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr double kMegabyte = 1e6;

/// Writable memory that the program has to itself [byte], as the kernel counts it for the limit.
double presentMemory() {
  constexpr double kKilobyte = 1024.0;
  std::ifstream status("/proc/self/status");
  std::string key;
  while (status >> key) {
    if (key == "VmData:") {
      double kilobytes = 0.0;
      status >> kilobytes;
      return kKilobyte * kilobytes;
    }
    status.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  throw Error("/proc/self/status does not tell the memory of the program.");
}

}  // namespace

// Not RLIMIT_AS: address space that is only reserved, as by threads and sanitizers, harms nobody.
void limitMemory(double megabytes) {
  rlimit limit = {};
  bool is_limited = ::getrlimit(RLIMIT_DATA, &limit) == 0;
  limit.rlim_cur = static_cast<rlim_t>(presentMemory() + kMegabyte * megabytes);
  if (limit.rlim_cur > limit.rlim_max) {
    return;  // whoever started the program allows less
  }
  is_limited = is_limited && ::setrlimit(RLIMIT_DATA, &limit) == 0;
  if (!is_limited) {
    throw Error("The memory cannot be limited: " + std::generic_category().message(errno));
  }
}

}  // namespace sac
