#pragma once

#include <string>

namespace sac {

/// Makes this process the only one that writes a file: holds a lock on `<path>.lock`, which ends
/// with the process however it ends. The lock file stays; removing it could hand out two locks.
class ProcessLock {
 public:
  /// Throws DataError when another process, or another object of this one, holds the lock, or the
  /// lock file cannot be made.
  explicit ProcessLock(const std::string& path);
  ~ProcessLock();
  ProcessLock(const ProcessLock&) = delete;
  ProcessLock& operator=(const ProcessLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace sac
