#include "spherical_actuator_calibration/base/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <sys/stat.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/folder_sync.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void failWith(const fs::path& path, int error) {
  throw DataError(path.string() + ": cannot be written: " + std::generic_category().message(error) +
                  ".");
}

[[noreturn]] void failExists(const fs::path& path) {
  throw DataError(path.string() + ": the file exists already; remove it or choose another name.");
}

/// A new file next to its later place. Invariant: as long as this object lives and publish() has
/// not succeeded, destroying it removes the file.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target) {
    // Another process, or one that crashed before, may hold a name: take the next.
    constexpr int kAttempts = 1000;
    // Not of the whole name: what is added would make a long one longer than a file's may be.
    constexpr std::size_t kLongest = 100;
    const std::string name = target.filename().string().substr(0, kLongest);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      path_ = target.parent_path() /
              ("." + name + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt));
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
      if (descriptor_ >= 0) {
        return;
      }
      if (errno != EEXIST) {
        break;
      }
    }
    failWith(target, errno);
  }

  ~TemporaryFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    if (!published_) {
      ::unlink(path_.c_str());
    }
  }

  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void setPermissions(mode_t permissions) {
    if (::fchmod(descriptor_, permissions) != 0) {
      failWith(target_, errno);
    }
  }

  /// Returns when the content is on the disk.
  void write(const std::string& content) {
    std::size_t done = 0;
    while (done < content.size()) {
      const ssize_t count = ::write(descriptor_, content.data() + done, content.size() - done);
      if (count < 0 && errno != EINTR) {
        failWith(target_, errno);
      }
      done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    if (::fsync(descriptor_) != 0) {
      failWith(target_, errno);
    }
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) {
      failWith(target_, errno);
    }
  }

  /// Gives the file its name.
  void publish(OverwritePolicy policy) {
    if (policy == OverwritePolicy::kRefuse) {
      // A hard link never replaces: no other process can slip in between check and rename.
      if (::link(path_.c_str(), target_.c_str()) == 0) {
        return;
      }
      if (errno == EEXIST) {
        failExists(target_);
      }
      // File systems without hard links are left with the check made before.
    }
    if (::rename(path_.c_str(), target_.c_str()) != 0) {
      failWith(target_, errno);
    }
    published_ = true;
  }

 private:
  static constexpr mode_t kMode = 0666;  // narrowed by the process's umask

  fs::path target_;
  fs::path path_;
  int descriptor_ = -1;
  bool published_ = false;
};

}  // namespace

void writeFileAtomically(const std::string& path,
                         const std::string& content,
                         OverwritePolicy policy) {
  std::error_code error;
  const fs::path target = fs::absolute(path, error);
  if (error || !target.has_filename()) {
    throw DataError("\"" + path + "\" is not the name of a file.");
  }
  struct stat existing = {};
  const bool exists = ::stat(target.c_str(), &existing) == 0;
  if (exists && !S_ISREG(existing.st_mode)) {
    throw DataError(path + ": this is not a regular file; choose another name.");
  }
  if (exists && policy == OverwritePolicy::kRefuse) {
    failExists(path);
  }
  TemporaryFile file(target);
  if (exists) {
    constexpr mode_t kPermissions = 07777;
    file.setPermissions(existing.st_mode & kPermissions);
  }
  file.write(content);
  file.publish(policy);
  // The new name itself survives a power failure.
  syncFolder(target.parent_path());
}

}  // namespace sac
