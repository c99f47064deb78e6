#pragma once

#include <memory>
#include <string>
#include <vector>

namespace sac {

struct BagFile;

/// Recordings that are open for reading, of which every byte that rosbag's reader believes was
/// verified.
class OpenRecordings {
 public:
  /// Throws DataError, naming the file and what to do about it, for a bag that is missing, given
  /// twice, not indexed, damaged or without messages.
  explicit OpenRecordings(const std::vector<std::string>& paths);
  ~OpenRecordings();
  OpenRecordings(const OpenRecordings&) = delete;
  OpenRecordings& operator=(const OpenRecordings&) = delete;

  const std::vector<std::unique_ptr<BagFile>>& bags() const { return bags_; }

 private:
  std::vector<std::unique_ptr<BagFile>> bags_;
};

}  // namespace sac
