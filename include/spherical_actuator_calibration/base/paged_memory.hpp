#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

namespace sac {

class MappedFile;

/// Bytes in one piece, of which there may be many. Few of them lie in memory; more in a file
/// without a name, in TMPDIR, or in /var/tmp where that is not set. Of all such files of a process
/// 8 MiB and what was used last are in its memory; the rest is in the page cache of the system, or
/// on the disk. Where no such file can be had, as on a full disk, all bytes stay in memory.
class PagedMemory {
 public:
  PagedMemory();
  PagedMemory(PagedMemory&& other) noexcept;
  PagedMemory& operator=(PagedMemory&& other) noexcept;
  ~PagedMemory();

  /// Room for so many bytes at least; keeps those that are there, and may move them. Throws
  /// std::bad_alloc.
  void reserve(std::size_t bytes);
  std::size_t capacity() const { return capacity_; }
  /// Aligned for any type; null: there is no room.
  char* data() const { return data_; }

  /// Is to be told before a byte is used: the pages of one used without it stay in memory until
  /// enough others were used. From any thread.
  void touch(std::size_t byte) const {
    const std::size_t piece = byte >> kPieceBits;
    if (touched_ != nullptr && !touched_[piece].load(std::memory_order_relaxed)) {
      countTouched(piece);
    }
  }

 private:
  static constexpr std::size_t kPieceBits = 18;

  void swap(PagedMemory& other) noexcept;
  bool reserveInFile(std::size_t bytes);
  void reserveInMemory(std::size_t bytes);
  void countTouched(std::size_t piece) const;

  char* data_ = nullptr;
  std::size_t capacity_ = 0;
  std::unique_ptr<MappedFile> file_;
  std::atomic<bool>* touched_ = nullptr;  ///< per piece of the file; null: there is none
};

}  // namespace sac
