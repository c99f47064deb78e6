#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

namespace sac {

/// A file without a name, in TMPDIR, or in /var/tmp where that is not set, of which all is mapped.
/// All such files of a process together keep 8 MiB and what was touched last in its memory.
class MappedFile {
 public:
  /// Null: there can be none of that size.
  static std::unique_ptr<MappedFile> make(std::size_t bytes);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  /// Whether there is room for so many bytes now; bytes may move. It takes the blocks of the disk:
  /// a page that finds none later would end the process.
  bool grow(std::size_t bytes);
  char* data() const { return data_; }

  /// Pieces of this size come and go together [bytes].
  static constexpr std::size_t kPiece = std::size_t{1} << 18U;
  /// Per piece, whether it was touched since pages left the process last.
  std::atomic<bool>* touched() const { return touched_.get(); }
  /// A piece that was not touched is about to be used.
  void touch(std::size_t piece);

 private:
  friend class ResidentPages;

  explicit MappedFile(int descriptor);

  static std::size_t piecesOf(std::size_t bytes) { return (bytes + kPiece - 1) / kPiece; }
  void rest();

  int descriptor_;
  char* data_ = nullptr;
  std::size_t bytes_ = 0;
  std::unique_ptr<std::atomic<bool>[]> touched_;
};

}  // namespace sac
