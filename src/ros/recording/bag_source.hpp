#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <rosbag/chunked_file.h>
#include <rosbag/stream.h>

#include "bag_records.hpp"

namespace sac {

/// rosbag holds a chunk twice, as it is in the file and unpacked; so does this package.
inline constexpr std::size_t kLargestChunk = std::size_t{128} << 20U;
/// Of connections and chunks: name, type and definition of a message, counts of topics.
inline constexpr std::size_t kLargestRecord = std::size_t{16} << 20U;

/// Bytes of a file, wherever they are.
class FileBytes {
 public:
  /// Throws BagDefect when the file cannot be opened.
  explicit FileBytes(const std::string& path);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  /// Throws BagDefect unless all of them are there.
  std::string at(std::uint64_t position, std::size_t size) const;
  /// The same into a buffer that is used again.
  void read(std::uint64_t position, std::size_t size, std::string& bytes) const;

 private:
  void close() const;

  int descriptor_;
  std::uint64_t size_ = 0;
};

/// A record of the file, and where it ends there.
struct FileRecord {
  std::string bytes;
  std::size_t header_size = 0;
  std::uint64_t end = 0;

  BagFields fields() const;
  std::string_view data() const;
};

/// The record at a position of a file. Header and data lengths are believed only where the bytes
/// are there and not more than `largest`. Throws BagDefect otherwise.
FileRecord recordOfFile(const FileBytes& file, std::uint64_t position, std::size_t largest);

/// The same without its data: of a record that is not read yet.
FileRecord headerOfFile(const FileBytes& file, std::uint64_t position, std::size_t largest);

/// Unpacks chunks, with memory that is used again.
class Unpacker {
 public:
  Unpacker() : streams_(&unused_) {}

  /// Makes `records` those of the chunk at a position. Throws BagDefect, or what rosbag throws,
  /// when it cannot be unpacked.
  void unpack(const FileBytes& file, std::uint64_t position, std::string& records);

 private:
  rosbag::ChunkedFile unused_;  ///< the streams want one; it stays closed
  rosbag::StreamFactory streams_;
  std::string packed_;
};

}  // namespace sac
