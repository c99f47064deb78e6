// Preloaded into a node under test, so that its wall clock jumps and its control loop throws when a
// file says so: the test maps that file (FAULTS) and writes into it.

#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

#include <sys/mman.h>
#include <sys/select.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

namespace {

struct Faults {
  std::int64_t clock_jump;  // [s] of the wall clock
  std::int64_t throws;      // not 0: the next select() does
};

volatile Faults* faults() {
  static volatile Faults* const mapped = [] {
    const int file = open(std::getenv("FAULTS"), O_RDWR);
    return static_cast<volatile Faults*>(
        mmap(nullptr, sizeof(Faults), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
  }();
  return mapped;
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const auto real = next<int (*)(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, time);
  if (clock == CLOCK_REALTIME) {
    time->tv_sec += faults()->clock_jump;
  }
  return result;
}

// Only the transport waits by select().
extern "C" int select(
    int count, fd_set* reading, fd_set* writing, fd_set* failing, timeval* timeout) {
  static const auto real = next<int (*)(int, fd_set*, fd_set*, fd_set*, timeval*)>("select");
  if (faults()->throws != 0) {
    faults()->throws = 0;
    throw std::runtime_error("a fault that nobody thought of");
  }
  return real(count, reading, writing, failing, timeout);
}
