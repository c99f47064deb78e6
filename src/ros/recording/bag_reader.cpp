#include "bag_reader.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <optional>
#include <tuple>

namespace sac {

/// The messages of one connection in one chunk.
struct BagReader::Part {
  Chunk* chunk = nullptr;
  std::uint32_t connection = 0;
  ros::Time time;                 ///< of the next message
  std::vector<BagEntry> entries;  ///< sorted by time; empty until the first of them is read
  std::size_t next = 0;
};

struct BagReader::Chunk {
  const BagFile* file = nullptr;
  const BagChunk* place = nullptr;
  std::size_t order = 0;  ///< in its bag
  std::vector<std::unique_ptr<Part>> parts;
  std::optional<UnpackedChunk> unpacked;

  void readParts() {
    const FileRecord header = headerOfFile(file->bytes, place->position, kLargestChunk);
    auto entries = readEntries(file->bytes, header.end, place->index_records);
    for (const auto& part : parts) {
      part->entries = std::move(entries[part->connection]);
      std::stable_sort(part->entries.begin(),
                       part->entries.end(),
                       [](const BagEntry& a, const BagEntry& b) { return a.time < b.time; });
      if (part->entries.empty() || part->entries.front().time != part->time) {
        throw BagDefect("its index changed while it was being read");
      }
    }
  }
};

/// The messages of one connection.
struct BagReader::Stream {
  const BagConnection* connection = nullptr;
  std::vector<Part*> parts;  ///< a heap: the one with the next message comes first

  static bool isLater(const Part* a, const Part* b) {
    return std::tie(a->time, a->chunk->order) > std::tie(b->time, b->chunk->order);
  }

  void add(Part* part) {
    parts.push_back(part);
    std::push_heap(parts.begin(), parts.end(), isLater);
  }

  void advance() {
    Part& part = *parts.front();
    const bool is_over = ++part.next == part.entries.size();
    if (!is_over) {
      part.time = part.entries[part.next].time;
      const auto comes_before = [&](std::size_t n) {
        return n < parts.size() && isLater(&part, parts[n]);
      };
      if (!comes_before(1) && !comes_before(2)) {
        return;
      }
    }
    std::pop_heap(parts.begin(), parts.end(), isLater);
    if (is_over) {
      part.entries = {};
      parts.pop_back();
    } else {
      std::push_heap(parts.begin(), parts.end(), isLater);
    }
  }
};

BagReader::BagReader(const BagGroup& bags,
                     const std::vector<std::string>& topics,
                     std::size_t most_unpacked)
    : most_unpacked_(most_unpacked) {
  for (const BagFile* file : bags) {
    addBag(*file, topics);
  }
  for (const auto& stream : streams_) {
    running_.push_back(stream.get());
  }
  sort();
}

BagReader::~BagReader() = default;

void BagReader::addBag(const BagFile& file, const std::vector<std::string>& topics) {
  std::map<std::uint32_t, std::unique_ptr<Stream>> streams;
  for (const BagChunk& place : file.index.chunks) {
    auto chunk = std::make_unique<Chunk>(Chunk{&file, &place, chunks_.size(), {}, {}});
    for (const auto& [number, begin, end] : place.parts) {
      const BagConnection& connection = file.index.connections.at(number);
      if (std::find(topics.begin(), topics.end(), connection.topic) == topics.end()) {
        continue;
      }
      chunk->parts.push_back(std::make_unique<Part>(Part{chunk.get(), number, begin, {}, 0}));
      std::unique_ptr<Stream>& stream = streams[number];
      if (!stream) {
        stream = std::make_unique<Stream>(Stream{&connection, {}});
      }
      stream->add(chunk->parts.back().get());
      const bool is_first = begin_.isZero();
      begin_ = is_first ? begin : std::min(begin_, begin);
      end_ = is_first ? end : std::max(end_, end);
    }
    chunks_.push_back(std::move(chunk));
  }
  for (auto& [number, stream] : streams) {
    streams_.push_back(std::move(stream));
  }
}

/// As rosbag::View does before each message: it decides which of the same time comes first.
void BagReader::sort() {
  std::sort(running_.begin(), running_.end(), [](const Stream* a, const Stream* b) {
    return a->parts.front()->time > b->parts.front()->time;
  });
}

bool BagReader::next(BagMessage& message) {
  if (has_begun_) {
    running_.back()->advance();
    if (running_.back()->parts.empty()) {
      running_.pop_back();
    }
    sort();
  }
  has_begun_ = !running_.empty();
  if (!has_begun_) {
    return false;
  }
  Part& part = *running_.back()->parts.front();
  message.connection = running_.back()->connection;
  message.time = part.time;
  try {
    read(part, message);
  } catch (const std::exception& error) {
    throw unreadableBag(part.chunk->file->path, error);
  }
  return true;
}

void BagReader::read(Part& part, BagMessage& message) {
  Chunk& chunk = *part.chunk;
  if (unpacked_.empty() || unpacked_.front() != &chunk) {
    unpack(chunk);
  }
  if (part.entries.empty()) {
    chunk.readParts();
  }
  const BagRecord record = recordAt(chunk.unpacked->records(), part.entries[part.next].offset);
  record.fields.requireOp(BagOp::kMessageData);
  if (record.fields.number<std::uint32_t>("conn") != part.connection) {
    throw BagDefect("its index points to a message of another connection");
  }
  message.data = record.data;
}

void BagReader::unpack(Chunk& chunk) {
  if (chunk.unpacked) {
    unpacked_.splice(
        unpacked_.begin(), unpacked_, std::find(unpacked_.begin(), unpacked_.end(), &chunk));
    return;
  }
  chunk.unpacked.emplace(recordOfFile(chunk.file->bytes, chunk.place->position, kLargestChunk));
  unpacked_.push_front(&chunk);
  std::size_t bytes = 0;
  for (auto it = unpacked_.begin(); it != unpacked_.end();) {
    bytes += (*it)->unpacked->records().size();
    if (bytes > most_unpacked_ && *it != &chunk) {
      (*it)->unpacked.reset();
      it = unpacked_.erase(it);
    } else {
      ++it;
    }
  }
}

}  // namespace sac
