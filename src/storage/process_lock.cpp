#include "process_lock.hpp"

#include <cerrno>
#include <limits>
#include <mutex>
#include <set>
#include <system_error>

#include <sys/stat.h>

#include "spherical_actuator_calibration/base/error.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

[[noreturn]] void failUnopened(const std::string& path, const std::string& reason) {
  throw DataError(path +
                  ": the session database cannot be opened, because the file or its folder cannot "
                  "be used (" +
                  reason +
                  "); check that the folder exists, its permissions, and whether the disk is "
                  "mounted read-only.");
}

[[noreturn]] void failUnopened(const std::string& path, int error) {
  failUnopened(path, std::generic_category().message(error));
}

[[noreturn]] void failHeld(const std::string& path) {
  throw DataError(path +
                  ": another calibration node works with this session; stop it first, or give "
                  "this one another directory.");
}

FileIdentity identityOf(const struct stat& status) {
  return {status.st_dev, status.st_ino};
}

/// Files that this process holds: one must not even be opened again, since closing any descriptor
/// of it would drop SQLite's own locks.
class HeldFiles {
 public:
  static bool has(const FileIdentity& file) {
    const std::lock_guard<std::mutex> lock(mutex());
    return files().count(file) > 0;
  }
  static void add(const FileIdentity& file) {
    const std::lock_guard<std::mutex> lock(mutex());
    files().insert(file);
  }
  static void remove(const FileIdentity& file) {
    const std::lock_guard<std::mutex> lock(mutex());
    files().erase(file);
  }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::set<FileIdentity>& files() {
    static std::set<FileIdentity> files;
    return files;
  }
};

/// Locks a byte far behind those that SQLite locks. Belongs to the open file and not to the
/// process: SQLite's own locks do not touch it.
bool lockFile(int descriptor) {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = std::numeric_limits<off_t>::max() - 1;
  lock.l_len = 1;
  return ::fcntl(descriptor, F_OFD_SETLK, &lock) == 0;
}

}  // namespace

FileIdentity identityOf(const std::string& path) {
  struct stat status = {};
  return ::stat(path.c_str(), &status) == 0 ? identityOf(status) : FileIdentity{};
}

ProcessLock::ProcessLock(const std::string& path) {
  if (HeldFiles::has(identityOf(path))) {
    failHeld(path);
  }
  constexpr mode_t kMode = 0644;  // narrowed by the process's umask
  const int descriptor =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, kMode);
  if (descriptor < 0) {
    failUnopened(path, errno);
  }
  struct stat status = {};
  const bool is_file = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const bool is_locked = is_file && lockFile(descriptor);
  const int error = errno;
  // Whoever replaces the file meanwhile shall not have us lock what has no name.
  const bool is_there = is_locked && identityOf(path) == identityOf(status);
  if (is_there) {
    descriptor_ = descriptor;
    file_ = identityOf(status);
    HeldFiles::add(file_);
    return;
  }
  ::close(descriptor);
  if (!is_file) {
    failUnopened(path, "it is not a regular file");
  }
  if (is_locked) {
    failUnopened(path, "it was replaced at this moment");
  }
  if (error == EAGAIN || error == EACCES) {
    failHeld(path);
  }
  failUnopened(path, error);
}

ProcessLock::~ProcessLock() {
  HeldFiles::remove(file_);
  ::close(descriptor_);
}

}  // namespace sac
