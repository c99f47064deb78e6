#include "bag_index.hpp"

#include <algorithm>
#include <cstddef>
#include <set>

namespace sac {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";

void requireVersion(const BagFields& fields) {
  if (fields.number<std::uint32_t>("ver") != 1) {
    throw BagDefect("its index is of another version");
  }
}

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
      index_.chunks.push_back({chunk, records, partsOf(chunk, records)});
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

  std::vector<ChunkPart> partsOf(std::uint64_t chunk, std::uint32_t records) const {
    const FileRecord header = headerOfFile(file_, chunk, kLargestChunk);
    header.fields().requireOp(BagOp::kChunk);
    std::vector<ChunkPart> parts;
    for (const auto& [connection, entries] : readEntries(file_, header.end, records)) {
      if (!entries.empty()) {
        const auto by_time = [](const BagEntry& a, const BagEntry& b) { return a.time < b.time; };
        const auto [first, last] = std::minmax_element(entries.begin(), entries.end(), by_time);
        parts.push_back({known(connection), first->time, last->time});
      }
    }
    return parts;
  }

  const FileBytes& file_;
  BagIndex index_;
};

}  // namespace

BagIndex readBagIndex(const FileBytes& file) {
  return IndexReader(file).read();
}

std::map<std::uint32_t, std::vector<BagEntry>> readEntries(const FileBytes& file,
                                                           std::uint64_t position,
                                                           std::uint32_t records) {
  constexpr std::size_t kNumber = sizeof(std::uint32_t);
  constexpr std::size_t kEntry = 3 * kNumber;
  std::map<std::uint32_t, std::vector<BagEntry>> result;
  for (std::uint32_t n = 0; n < records; ++n) {
    const FileRecord record = recordOfFile(file, position, kLargestChunk);
    const BagFields fields = record.fields();
    fields.requireOp(BagOp::kIndexData);
    requireVersion(fields);
    std::vector<BagEntry>& entries = result[fields.number<std::uint32_t>("conn")];
    const std::string_view data = record.data();
    if (data.size() != fields.number<std::uint32_t>("count") * kEntry) {
      throw BagDefect("an index has not the length that it says");
    }
    for (std::size_t at = 0; at < data.size(); at += kEntry) {
      BagEntry entry;
      entry.time.sec = numberAt<std::uint32_t>(data, at);
      entry.time.nsec = numberAt<std::uint32_t>(data, at + kNumber);
      entry.offset = numberAt<std::uint32_t>(data, at + 2 * kNumber);
      if (entry.time >= ros::TIME_MIN && entry.time <= ros::TIME_MAX) {
        entries.push_back(entry);
      }
    }
    position = record.end;
  }
  return result;
}

}  // namespace sac
