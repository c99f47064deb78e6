#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sac {

/// What stands in a database file at one moment, told from any other content.
class FileContent {
 public:
  /// Reads all of the file. Nothing that SQLite keeps in memory takes part.
  explicit FileContent(int descriptor);

  /// Whether one transaction of SQLite, which counts them in the file, made this of `before`; also
  /// one that had nothing to change.
  bool follows(const FileContent& before) const;

  bool operator==(const FileContent& other) const {
    return size_ == other.size_ && header_ == other.header_ && blocks_ == other.blocks_;
  }

 private:
  /// A number of the header, or 0 where the file is too short to have one.
  std::uint32_t number(std::size_t place, std::size_t bytes = sizeof(std::uint32_t)) const;
  /// As the header says.
  std::uint64_t wholeSize() const;

  std::uint64_t size_ = 0;
  std::string header_;
  std::vector<std::size_t> blocks_;  ///< a hash of each block
};

}  // namespace sac
