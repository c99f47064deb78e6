#include "bag_source.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <sys/stat.h>

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

std::size_t lengthAt(const FileBytes& file, std::uint64_t position, std::size_t largest) {
  const std::string bytes = file.at(position, kLengthSize);
  const std::size_t length = numberAt<std::uint32_t>(bytes, 0);
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
  std::string bytes;
  read(position, size, bytes);
  return bytes;
}

void FileBytes::read(std::uint64_t position, std::size_t size, std::string& bytes) const {
  if (position > size_ || size > size_ - position) {
    throw BagDefect("it ends before what it says that it holds");
  }
  bytes.resize(size);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count =
        ::pread(descriptor_, bytes.data() + done, size - done, static_cast<off_t>(position + done));
    if (count == 0 || (count < 0 && errno != EINTR)) {
      throw BagDefect("it ends while it is being read");
    }
    done += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  }
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

void Unpacker::unpack(const FileBytes& file, std::uint64_t position, std::string& records) {
  const FileRecord header = headerOfFile(file, position, kLargestChunk);
  const BagFields fields = header.fields();
  fields.requireOp(BagOp::kChunk);
  const std::size_t size = fields.number<std::uint32_t>("size");
  const std::string compression(fields.text("compression"));
  const std::uint64_t begin = position + header.bytes.size();
  const std::size_t packed_size = header.end - begin;
  if (compression == "none") {
    if (packed_size != size) {
      throw BagDefect("a chunk has not the size that it says");
    }
    file.read(begin, size, records);
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
  file.read(begin, packed_size, packed_);
  if (is_bz2) {
    // What no byte is unpacked into stays zero, and is no record. LZ4 fills all, or is refused.
    records.clear();
  }
  records.resize(size);
  const auto bytes_of = [](std::string& text) {
    void* const bytes = text.data();
    return static_cast<std::uint8_t*>(bytes);
  };
  streams_.getStream(is_bz2 ? rosbag::compression::BZ2 : rosbag::compression::LZ4)
      ->decompress(bytes_of(records),
                   static_cast<unsigned>(size),
                   bytes_of(packed_),
                   static_cast<unsigned>(packed_size));
}

}  // namespace sac
