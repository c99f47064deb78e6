#pragma once

#include <string>

#include <sys/types.h>

namespace sac {

/// Which file stands at a path, whatever its name.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;

  bool operator==(const FileIdentity& other) const {
    return device == other.device && inode == other.inode;
  }
  bool operator<(const FileIdentity& other) const {
    return device != other.device ? device < other.device : inode < other.inode;
  }
};

/// Of the file at a path; zero when there is none.
FileIdentity identityOf(const std::string& path);

/// Makes this process the only one that writes a database file, which is made when it is not there.
/// The lock is on the file itself, not on another one that somebody could remove, and ends with the
/// process however it ends.
class ProcessLock {
 public:
  /// Throws DataError when another process, or another object of this one, holds the lock, or the
  /// file cannot be opened or made.
  explicit ProcessLock(const std::string& path);
  /// Precondition: nothing else of this process has the file open.
  ~ProcessLock();
  ProcessLock(const ProcessLock&) = delete;
  ProcessLock& operator=(const ProcessLock&) = delete;

  /// The file that is locked.
  const FileIdentity& file() const { return file_; }
  /// It, open to be read. Another descriptor of it must not be made: closing that would drop the
  /// locks of SQLite.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
  FileIdentity file_;
};

}  // namespace sac
