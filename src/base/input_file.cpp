#include "spherical_actuator_calibration/base/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <sys/stat.h>

#include "spherical_actuator_calibration/base/error.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

/// Closes a descriptor at the end of a scope.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

std::string kindOf(const struct stat& status) {
  switch (status.st_mode & S_IFMT) {
    case S_IFREG:
      return "";
    case S_IFDIR:
      return "a folder";
    case S_IFIFO:
      return "a FIFO";
    case S_IFSOCK:
      return "a socket";
    default:
      return "a device";
  }
}

[[noreturn]] void failUnread(const std::string& path, int error) {
  throw ConfigError(path + ": cannot be read: " + std::generic_category().message(error) + ".");
}

[[noreturn]] void failLarge(const std::string& path, std::size_t largest) {
  throw ConfigError(path + ": is larger than " + std::to_string(largest) +
                    " bytes, the most that is read of such a file.");
}

}  // namespace

std::string readInputFile(const std::string& path, std::size_t largest) {
  // Not blocking: opening a FIFO would wait for somebody who writes.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  struct stat status = {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) {
    failUnread(path, errno);
  }
  const std::string kind = kindOf(status);
  if (!kind.empty()) {
    throw ConfigError(path + ": is " + kind + ", not a file.");
  }
  if (status.st_size > 0 && static_cast<std::size_t>(status.st_size) > largest) {
    failLarge(path, largest);
  }
  // Read as it comes: what /proc and /sys hold has no size before, and a file may grow.
  constexpr std::size_t kPiece = std::size_t{1} << 16U;
  std::string text;
  for (;;) {
    const std::size_t size = text.size();
    text.resize(size + kPiece);
    const ssize_t count = ::read(file.get(), text.data() + size, kPiece);
    if (count < 0 && errno != EINTR) {
      failUnread(path, errno);
    }
    text.resize(size + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (text.size() > largest) {
      failLarge(path, largest);
    }
    if (count == 0) {
      return text;
    }
  }
}

std::string unreadableKind(const std::string& path) {
  struct stat status = {};
  return ::stat(path.c_str(), &status) == 0 ? kindOf(status) : "";
}

}  // namespace sac
