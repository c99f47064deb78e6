#include "bag_verifier.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <rosbag/chunked_file.h>
#include <rosbag/stream.h>
#include <sys/stat.h>

#include "bag_records.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace sac {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";

/// rosbag holds a chunk twice, as it is in the file and unpacked.
constexpr std::size_t kLargestChunk = std::size_t{128} << 20U;
/// Of connections and chunks: name, type and definition of a message, counts of topics.
constexpr std::size_t kLargestRecord = std::size_t{16} << 20U;

constexpr std::size_t kLengthSize = sizeof(std::uint32_t);

/// Bytes of a file, wherever they are.
class FileBytes {
 public:
  explicit FileBytes(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    struct stat status = {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
      const int error = errno;
      close();
      throw BagDefect(std::generic_category().message(error));
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
  }
  ~FileBytes() { close(); }
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  std::string at(std::uint64_t position, std::size_t size) const {
    if (position > size_ || size > size_ - position) {
      throw BagDefect("it ends before what it says that it holds");
    }
    std::string bytes(size, '\0');
    std::size_t done = 0;
    while (done < size) {
      const ssize_t count = ::pread(
          descriptor_, bytes.data() + done, size - done, static_cast<off_t>(position + done));
      if (count == 0 || (count < 0 && errno != EINTR)) {
        throw BagDefect("it ends while it is being read");
      }
      done += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    }
    return bytes;
  }

 private:
  void close() const {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }

  int descriptor_;
  std::uint64_t size_ = 0;
};

/// A record of the file, and where it ends there.
struct FileRecord {
  std::string bytes;
  std::size_t header_size = 0;
  std::uint64_t end = 0;

  BagFields fields() const {
    return BagFields(std::string_view(bytes).substr(kLengthSize, header_size));
  }
  std::string_view data() const {
    return std::string_view(bytes).substr(header_size + 2 * kLengthSize);
  }
};

/// One message in a chunk.
struct PlacedMessage {
  std::uint32_t offset;
  std::uint32_t connection;

  bool operator<(const PlacedMessage& other) const {
    return std::pair(offset, connection) < std::pair(other.offset, other.connection);
  }
};

class BagVerifier {
 public:
  explicit BagVerifier(const std::string& path) : file_(path), streams_(&unused_) {}

  void verify() {
    constexpr std::size_t kMagicSize = sizeof kMagic - 1;
    if (file_.at(0, kMagicSize) != kMagic) {
      throw BagDefect("it does not begin like a bag of format 2.0");
    }
    const FileRecord header = recordOfFile(kMagicSize, kLargestRecord);
    const BagFields fields = header.fields();
    fields.requireOp(BagOp::kBagHeader);
    const auto index = fields.number<std::uint64_t>("index_pos");
    if (index == 0) {
      return;
    }
    if (!fields.text("encryptor").empty()) {
      throw BagDefect("it is encrypted");
    }
    const auto connections = fields.number<std::uint32_t>("conn_count");
    const auto chunks = fields.number<std::uint32_t>("chunk_count");
    verifyChunks(verifyConnections(index, connections), chunks);
  }

 private:
  /// Header and data lengths are believed only where the bytes are there and not too many.
  FileRecord recordOfFile(std::uint64_t position, std::size_t largest) const {
    const std::size_t header_size = lengthAt(position, largest);
    const std::size_t data_size = lengthAt(position + kLengthSize + header_size, largest);
    const std::size_t size = header_size + data_size + 2 * kLengthSize;
    return {file_.at(position, size), header_size, position + size};
  }

  std::size_t lengthAt(std::uint64_t position, std::size_t largest) const {
    const std::size_t length = numberAt<std::uint32_t>(file_.at(position, kLengthSize), 0);
    if (length > largest) {
      throw BagDefect("a record says that it is " + std::to_string(length) + " bytes long; " +
                      std::to_string(largest) + " are the most that is read");
    }
    return length;
  }

  /// Returns where they end.
  std::uint64_t verifyConnections(std::uint64_t position, std::uint32_t count) {
    for (std::uint32_t n = 0; n < count; ++n) {
      const FileRecord record = recordOfFile(position, kLargestRecord);
      const BagFields fields = record.fields();
      fields.requireOp(BagOp::kConnection);
      if (!connections_.insert(fields.number<std::uint32_t>("conn")).second) {
        throw BagDefect("two connections have the same number");
      }
      static_cast<void>(BagFields(record.data()));
      position = record.end;
    }
    return position;
  }

  void verifyChunks(std::uint64_t position, std::uint32_t count) {
    std::set<std::uint64_t> known;
    for (std::uint32_t n = 0; n < count; ++n) {
      const FileRecord info = recordOfFile(position, kLargestRecord);
      const BagFields fields = info.fields();
      fields.requireOp(BagOp::kChunkInfo);
      requireVersion(fields);
      const auto chunk = fields.number<std::uint64_t>("chunk_pos");
      if (!known.insert(chunk).second) {
        throw BagDefect("a chunk is listed twice");
      }
      const std::uint32_t indexes =
          verifyCounts(info.data(), fields.number<std::uint32_t>("count"));
      verifyChunk(chunk, indexes);
      position = info.end;
    }
  }

  static void requireVersion(const BagFields& fields) {
    if (fields.number<std::uint32_t>("ver") != 1) {
      throw BagDefect("its index is of another version");
    }
  }

  /// Numbers of messages by connection; returns of how many connections.
  std::uint32_t verifyCounts(std::string_view data, std::uint32_t count) const {
    constexpr std::size_t kEntry = 2 * sizeof(std::uint32_t);
    if (data.size() != count * kEntry) {
      throw BagDefect("a list of counts has not the length that it says");
    }
    std::set<std::uint32_t> listed;
    for (std::size_t offset = 0; offset < data.size(); offset += kEntry) {
      if (!listed.insert(knownConnection(numberAt<std::uint32_t>(data, offset))).second) {
        throw BagDefect("a connection is counted twice");
      }
    }
    return count;
  }

  std::uint32_t knownConnection(std::uint32_t connection) const {
    if (connections_.count(connection) == 0) {
      throw BagDefect("it refers to a connection that it does not have");
    }
    return connection;
  }

  void verifyChunk(std::uint64_t position, std::uint32_t indexes) {
    std::uint64_t after = 0;
    const std::vector<PlacedMessage> messages = messagesOfChunk(position, after);
    for (std::uint32_t n = 0; n < indexes; ++n) {
      const FileRecord index = recordOfFile(after, kLargestChunk);
      verifyIndex(index, messages);
      after = index.end;
    }
  }

  /// In the order of their offsets.
  std::vector<PlacedMessage> messagesOfChunk(std::uint64_t position, std::uint64_t& after) {
    const FileRecord chunk = recordOfFile(position, kLargestChunk);
    const BagFields fields = chunk.fields();
    fields.requireOp(BagOp::kChunk);
    const std::size_t size = fields.number<std::uint32_t>("size");
    const std::string_view compression = fields.text("compression");
    after = chunk.end;
    if (compression == "none" && chunk.data().size() != size) {
      throw BagDefect("a chunk has not the size that it says");
    }
    return compression == "none" ? messagesIn(chunk.data())
                                 : messagesIn(unpacked(chunk.data(), compression, size));
  }

  std::string unpacked(std::string_view data, std::string_view compression, std::size_t size) {
    if (size > kLargestChunk) {
      throw BagDefect("a chunk says that it unpacks to " + std::to_string(size) + " bytes; " +
                      std::to_string(kLargestChunk) + " are the most that is read");
    }
    const bool is_bz2 = compression == "bz2";
    if (!is_bz2 && compression != "lz4") {
      throw BagDefect("a chunk is compressed in an unknown way");
    }
    // What no byte is unpacked into stays zero, and is no record.
    std::string packed(data);
    std::string bytes(size, '\0');
    const auto as_bytes = [](std::string& text) {
      return reinterpret_cast<std::uint8_t*>(text.data());  // NOLINT: as rosbag has it
    };
    streams_.getStream(is_bz2 ? rosbag::compression::BZ2 : rosbag::compression::LZ4)
        ->decompress(as_bytes(bytes),
                     static_cast<unsigned>(size),
                     as_bytes(packed),
                     static_cast<unsigned>(packed.size()));
    return bytes;
  }

  std::vector<PlacedMessage> messagesIn(std::string_view bytes) const {
    std::vector<PlacedMessage> messages;
    std::size_t offset = 0;
    while (offset < bytes.size()) {
      const BagRecord record = recordAt(bytes, offset);
      if (record.fields.op() == BagOp::kMessageData) {
        messages.push_back({static_cast<std::uint32_t>(offset),
                            knownConnection(record.fields.number<std::uint32_t>("conn"))});
      } else {
        record.fields.requireOp(BagOp::kConnection);
      }
      offset = record.end;
    }
    return messages;
  }

  void verifyIndex(const FileRecord& index, const std::vector<PlacedMessage>& messages) const {
    const BagFields fields = index.fields();
    fields.requireOp(BagOp::kIndexData);
    requireVersion(fields);
    const std::uint32_t connection = knownConnection(fields.number<std::uint32_t>("conn"));
    constexpr std::size_t kEntry = 3 * sizeof(std::uint32_t);
    constexpr std::size_t kOffset = 2 * sizeof(std::uint32_t);
    if (index.data().size() != fields.number<std::uint32_t>("count") * kEntry) {
      throw BagDefect("an index has not the length that it says");
    }
    for (std::size_t entry = 0; entry < index.data().size(); entry += kEntry) {
      const auto offset = numberAt<std::uint32_t>(index.data(), entry + kOffset);
      if (!std::binary_search(
              messages.begin(), messages.end(), PlacedMessage{offset, connection})) {
        throw BagDefect("its index points to what is no message");
      }
    }
  }

  FileBytes file_;
  std::set<std::uint32_t> connections_;
  rosbag::ChunkedFile unused_;  ///< the streams want one; it stays closed
  rosbag::StreamFactory streams_;
};

}  // namespace

void verifyBag(const std::string& path) {
  BagVerifier(path).verify();
}

}  // namespace sac
