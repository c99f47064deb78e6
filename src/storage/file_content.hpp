#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sac {

/// What stands in a database file at one moment, told from any other content.
class FileContent {
 public:
  /// Reads all of the file, which has pages of this size. Nothing that SQLite keeps in memory takes
  /// part.
  FileContent(int descriptor, std::size_t page);

  /// False for a page that is another here. Of anything but a whole page nothing is known.
  bool mayHold(std::uint64_t place, std::string_view bytes) const;
  /// Writes a page. Of anything else nothing is known afterwards: such a content equals none.
  void put(std::uint64_t place, std::string_view bytes);

  bool operator==(const FileContent& other) const {
    return is_known_ && other.is_known_ && pages_ == other.pages_;
  }

 private:
  bool isPage(std::uint64_t place, std::string_view bytes) const;

  std::size_t page_;
  bool is_known_ = true;
  std::vector<std::size_t> pages_;  ///< a hash of each
};

}  // namespace sac
