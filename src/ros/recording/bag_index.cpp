#include "bag_index.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>

namespace sac {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";

void requireVersion(const BagFields& fields) {
  if (fields.number<std::uint32_t>("ver") != 1) {
    throw BagDefect("its index is of another version");
  }
}

/// The messages of one connection in a chunk, as the file lists them.
class IndexRecord {
 public:
  IndexRecord(const FileBytes& file, std::uint64_t position)
      : record_(recordOfFile(file, position, kLargestChunk)) {
    const BagFields fields = record_.fields();
    fields.requireOp(BagOp::kIndexData);
    requireVersion(fields);
    connection_ = fields.number<std::uint32_t>("conn");
    if (record_.data().size() != fields.number<std::uint32_t>("count") * kEntry) {
      throw BagDefect("an index has not the length that it says");
    }
  }

  std::uint32_t connection() const { return connection_; }
  std::size_t count() const { return record_.data().size() / kEntry; }
  std::uint64_t end() const { return record_.end; }

  /// All but those that rosbag::View never hands out.
  template <typename Visitor>
  void visit(const Visitor& visitor) const {
    const std::uint64_t first = rankOf(ros::TIME_MIN);
    const std::uint64_t last = rankOf(ros::TIME_MAX);
    const std::string_view data = record_.data();
    for (std::size_t at = 0; at < data.size(); at += kEntry) {
      BagEntry entry;
      entry.time = timeAt(data, at);
      entry.offset = numberAt<std::uint32_t>(data, at + 2 * kNumber);
      if (rankOf(entry.time) >= first && rankOf(entry.time) <= last) {
        visitor(entry);
      }
    }
  }

 private:
  static constexpr std::size_t kNumber = sizeof(std::uint32_t);
  static constexpr std::size_t kEntry = 3 * kNumber;

  /// Whole seconds among the nanoseconds count as such, as in rosbag.
  static ros::Time timeAt(const std::string_view& data, std::size_t at) {
    constexpr std::uint32_t kSecond = 1000000000;  // [ns]
    const auto seconds = numberAt<std::uint32_t>(data, at);
    const auto nanoseconds = numberAt<std::uint32_t>(data, at + kNumber);
    if (std::numeric_limits<std::uint32_t>::max() - seconds < nanoseconds / kSecond) {
      throw BagDefect("a stamp of its index is beyond all time");
    }
    return {seconds + nanoseconds / kSecond, nanoseconds % kSecond};
  }

  FileRecord record_;
  std::uint32_t connection_ = 0;
};

class IndexReader {
 public:
  explicit IndexReader(const FileBytes& file) : file_(file) {}

  BagIndex read() {
    constexpr std::size_t kMagicSize = sizeof kMagic - 1;
    if (file_.at(0, kMagicSize) != kMagic) {
      throw BagDefect("it does not begin like a bag of format 2.0");
    }
    const FileRecord header = recordOfFile(file_, kMagicSize, kLargestRecord);
    const BagFields fields = header.fields();
    fields.requireOp(BagOp::kBagHeader);
    const auto position = fields.number<std::uint64_t>("index_pos");
    if (position == 0) {
      return {};
    }
    if (!fields.text("encryptor").empty()) {
      throw BagDefect("it is encrypted");
    }
    const auto connections = fields.number<std::uint32_t>("conn_count");
    const auto chunks = fields.number<std::uint32_t>("chunk_count");
    index_.is_complete = true;
    readChunks(readConnections(position, connections), chunks);
    return std::move(index_);
  }

 private:
  /// Returns where they end.
  std::uint64_t readConnections(std::uint64_t position, std::uint32_t count) {
    for (std::uint32_t n = 0; n < count; ++n) {
      const FileRecord record = recordOfFile(file_, position, kLargestRecord);
      const BagFields fields = record.fields();
      fields.requireOp(BagOp::kConnection);
      const std::string_view topic = fields.text("topic");
      if (topic.empty()) {
        throw BagDefect("a connection names no topic");
      }
      const BagFields header(record.data());
      const BagConnection connection{
          std::string(topic), std::string(header.text("type")), std::string(header.text("md5sum"))};
      if (!index_.connections.emplace(fields.number<std::uint32_t>("conn"), connection).second) {
        throw BagDefect("two connections have the same number");
      }
      position = record.end;
    }
    return position;
  }

  void readChunks(std::uint64_t position, std::uint32_t count) {
    std::set<std::uint64_t> known;
    for (std::uint32_t n = 0; n < count; ++n) {
      const FileRecord info = recordOfFile(file_, position, kLargestRecord);
      const BagFields fields = info.fields();
      fields.requireOp(BagOp::kChunkInfo);
      requireVersion(fields);
      const auto chunk = fields.number<std::uint64_t>("chunk_pos");
      if (!known.insert(chunk).second) {
        throw BagDefect("a chunk is listed twice");
      }
      const auto records = fields.number<std::uint32_t>("count");
      verifyCounts(info.data(), records);
      const FileRecord header = headerOfFile(file_, chunk, kLargestChunk);
      const BagFields chunk_fields = header.fields();
      chunk_fields.requireOp(BagOp::kChunk);
      const std::uint64_t size = header.end - chunk + chunk_fields.number<std::uint32_t>("size");
      index_.chunks.push_back({chunk, header.end, size, records, partsOf(header.end, records)});
      position = info.end;
    }
  }

  /// Numbers of messages by connection.
  void verifyCounts(std::string_view data, std::uint32_t count) const {
    constexpr std::size_t kEntry = 2 * sizeof(std::uint32_t);
    if (data.size() != count * kEntry) {
      throw BagDefect("a list of counts has not the length that it says");
    }
    std::set<std::uint32_t> listed;
    for (std::size_t offset = 0; offset < data.size(); offset += kEntry) {
      if (!listed.insert(known(numberAt<std::uint32_t>(data, offset))).second) {
        throw BagDefect("a connection is counted twice");
      }
    }
  }

  std::uint32_t known(std::uint32_t connection) const {
    if (index_.connections.count(connection) == 0) {
      throw BagDefect("it refers to a connection that it does not have");
    }
    return connection;
  }

  /// By the index records that begin at a position.
  std::vector<ChunkPart> partsOf(std::uint64_t position, std::uint32_t records) const {
    std::map<std::uint32_t, ChunkPart> parts;
    for (std::uint32_t n = 0; n < records; ++n) {
      const IndexRecord record(file_, position);
      record.visit([&](const BagEntry& entry) {
        const auto first = ChunkPart{record.connection(), entry.time, entry.time};
        ChunkPart& part = parts.try_emplace(record.connection(), first).first->second;
        part.begin = rankOf(entry.time) < rankOf(part.begin) ? entry.time : part.begin;
        part.end = rankOf(part.end) < rankOf(entry.time) ? entry.time : part.end;
      });
      position = record.end();
    }
    std::vector<ChunkPart> listed;
    for (const auto& [connection, part] : parts) {
      known(connection);
      listed.push_back(part);
    }
    return listed;
  }

  const FileBytes& file_;
  BagIndex index_;
};

}  // namespace

BagIndex readBagIndex(const FileBytes& file) {
  return IndexReader(file).read();
}

BagEntries readEntries(const FileBytes& file, std::uint64_t position, std::uint32_t records) {
  BagEntries result;
  for (std::uint32_t n = 0; n < records; ++n) {
    const IndexRecord record(file, position);
    std::vector<BagEntry>& entries = result[record.connection()];
    entries.reserve(entries.size() + record.count());
    record.visit([&](const BagEntry& entry) { entries.push_back(entry); });
    position = record.end();
  }
  return result;
}

}  // namespace sac
