#include "process_lock.hpp"

#include <cerrno>
#include <system_error>

#include <sys/file.h>

#include "spherical_actuator_calibration/base/error.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

[[noreturn]] void failWith(const std::string& path, int error) {
  throw DataError(path +
                  ": the lock file cannot be made: " + std::generic_category().message(error) +
                  "; check that the folder exists and can be written.");
}

}  // namespace

// Not a lock on the file itself: closing any descriptor of it would drop SQLite's own locks.
ProcessLock::ProcessLock(const std::string& path) {
  constexpr mode_t kMode = 0666;  // narrowed by the process's umask
  const std::string lock_path = path + ".lock";
  const int descriptor = ::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
  if (descriptor < 0) {
    failWith(lock_path, errno);
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    ::close(descriptor);
    if (error == EWOULDBLOCK) {
      throw DataError(path +
                      ": another calibration node works with this session; stop it first, or give "
                      "this one another directory.");
    }
    failWith(lock_path, error);
  }
  descriptor_ = descriptor;
}

ProcessLock::~ProcessLock() {
  ::close(descriptor_);
}

}  // namespace sac
