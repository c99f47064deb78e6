#include "bag_source.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <rosbag/chunked_file.h>
#include <rosbag/stream.h>
#include <sys/stat.h>

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

constexpr std::size_t kLengthSize = sizeof(std::uint32_t);

std::size_t lengthAt(const FileBytes& file, std::uint64_t position, std::size_t largest) {
  const std::size_t length = numberAt<std::uint32_t>(file.at(position, kLengthSize), 0);
  if (length > largest) {
    throw BagDefect("a record says that it is " + std::to_string(length) + " bytes long; " +
                    std::to_string(largest) + " are the most that is read");
  }
  return length;
}

/// Sizes of a record of the file.
struct RecordSize {
  RecordSize(const FileBytes& file, std::uint64_t position, std::size_t largest)
      : header(lengthAt(file, position, largest)),
        data(lengthAt(file, position + kLengthSize + header, largest)) {}

  std::size_t whole() const { return header + data + 2 * kLengthSize; }

  std::size_t header;
  std::size_t data;
};

}  // namespace

FileBytes::FileBytes(const std::string& path)
    : descriptor_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
  struct stat status = {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    const int error = errno;
    close();
    throw BagDefect(std::generic_category().message(error));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() {
  close();
}

void FileBytes::close() const {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

std::string FileBytes::at(std::uint64_t position, std::size_t size) const {
  if (position > size_ || size > size_ - position) {
    throw BagDefect("it ends before what it says that it holds");
  }
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count =
        ::pread(descriptor_, bytes.data() + done, size - done, static_cast<off_t>(position + done));
    if (count == 0 || (count < 0 && errno != EINTR)) {
      throw BagDefect("it ends while it is being read");
    }
    done += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  }
  return bytes;
}

BagFields FileRecord::fields() const {
  return BagFields(std::string_view(bytes).substr(kLengthSize, header_size));
}

std::string_view FileRecord::data() const {
  return std::string_view(bytes).substr(header_size + 2 * kLengthSize);
}

FileRecord recordOfFile(const FileBytes& file, std::uint64_t position, std::size_t largest) {
  const RecordSize size(file, position, largest);
  return {file.at(position, size.whole()), size.header, position + size.whole()};
}

FileRecord headerOfFile(const FileBytes& file, std::uint64_t position, std::size_t largest) {
  const RecordSize size(file, position, largest);
  return {file.at(position, size.header + 2 * kLengthSize), size.header, position + size.whole()};
}

UnpackedChunk::UnpackedChunk(FileRecord chunk) {
  const BagFields fields = chunk.fields();
  fields.requireOp(BagOp::kChunk);
  const std::size_t size = fields.number<std::uint32_t>("size");
  const std::string compression(fields.text("compression"));
  const std::size_t packed_size = chunk.data().size();
  if (compression == "none") {
    if (packed_size != size) {
      throw BagDefect("a chunk has not the size that it says");
    }
    first_ = chunk.bytes.size() - packed_size;
    bytes_ = std::move(chunk.bytes);
    return;
  }
  if (size > kLargestChunk) {
    throw BagDefect("a chunk says that it unpacks to " + std::to_string(size) + " bytes; " +
                    std::to_string(kLargestChunk) + " are the most that is read");
  }
  const bool is_bz2 = compression == "bz2";
  if (!is_bz2 && compression != "lz4") {
    throw BagDefect("a chunk is compressed in an unknown way");
  }
  // What no byte is unpacked into stays zero, and is no record.
  bytes_.assign(size, '\0');
  const auto bytes_at = [](std::string& text, std::size_t offset) {
    void* const bytes = text.data() + offset;
    return static_cast<std::uint8_t*>(bytes);
  };
  rosbag::ChunkedFile unused;  // the streams want one; it stays closed
  rosbag::StreamFactory(&unused)
      .getStream(is_bz2 ? rosbag::compression::BZ2 : rosbag::compression::LZ4)
      ->decompress(bytes_at(bytes_, 0),
                   static_cast<unsigned>(size),
                   bytes_at(chunk.bytes, chunk.bytes.size() - packed_size),
                   static_cast<unsigned>(packed_size));
}

}  // namespace sac
