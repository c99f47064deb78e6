#include "bag_reader.hpp"

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <new>
#include <tuple>
#include <utility>

namespace sac {

/// The messages of one connection in one chunk.
struct BagReader::Part {
  Chunk* chunk = nullptr;
  std::uint32_t connection = 0;
  std::uint64_t rank = 0;         ///< of the time of the next message
  std::vector<BagEntry> entries;  ///< sorted by time; empty until the chunk is loaded
  std::size_t next = 0;
};

struct BagReader::Chunk {
  const BagFile* file = nullptr;
  const BagChunk* place = nullptr;
  std::size_t order = 0;  ///< in its bag
  std::vector<std::unique_ptr<Part>> parts;
  std::size_t open_parts = 0;  ///< of which messages are still to be read
  bool is_begun = false;       ///< to be loaded, or was loaded
  bool is_unpacked = false;
  std::string records;

  std::uint64_t firstRank() const {
    std::uint64_t first = parts.front()->rank;
    for (const auto& part : parts) {
      first = std::min(first, part->rank);
    }
    return first;
  }

  void readParts() {
    BagEntries entries = readEntries(file->bytes, place->end, place->index_records);
    for (const auto& part : parts) {
      part->entries = std::move(entries[part->connection]);
      const auto is_before = [](const BagEntry& a, const BagEntry& b) {
        return rankOf(a.time) < rankOf(b.time);
      };
      // Mostly they are in order; then no memory is needed to sort them.
      if (!std::is_sorted(part->entries.begin(), part->entries.end(), is_before)) {
        std::stable_sort(part->entries.begin(), part->entries.end(), is_before);
      }
      if (part->entries.empty() || rankOf(part->entries.front().time) != part->rank) {
        throw BagDefect("its index changed while it was being read");
      }
    }
  }
};

/// The messages of one connection.
struct BagReader::Stream {
  const BagConnection* connection = nullptr;
  MessageRecords records;
  std::vector<Part*> parts;  ///< a heap: the one with the next message comes first

  static bool isLater(const Part* a, const Part* b) {
    return std::tie(a->rank, a->chunk->order) > std::tie(b->rank, b->chunk->order);
  }

  void add(Part* part) {
    parts.push_back(part);
    std::push_heap(parts.begin(), parts.end(), isLater);
  }

  /// To the next message. Returns whether that was the last one of its part.
  bool advance() {
    Part& part = *parts.front();
    const bool is_over = ++part.next == part.entries.size();
    if (!is_over) {
      part.rank = rankOf(part.entries[part.next].time);
      const auto comes_before = [&](std::size_t n) {
        return n < parts.size() && isLater(&part, parts[n]);
      };
      if (!comes_before(1) && !comes_before(2)) {
        return false;
      }
    }
    std::pop_heap(parts.begin(), parts.end(), isLater);
    if (is_over) {
      part.entries = {};
      parts.pop_back();
    } else {
      std::push_heap(parts.begin(), parts.end(), isLater);
    }
    return is_over;
  }
};

BagReader::BagReader(const BagGroup& bags,
                     const std::vector<std::string>& topics,
                     std::size_t most_unpacked)
    : most_unpacked_(most_unpacked), loader_(most_unpacked) {
  for (const BagFile* file : bags) {
    addBag(*file, topics);
  }
  for (const auto& stream : streams_) {
    running_.push_back({stream->parts.front()->rank, stream.get()});
  }
  sort();
  std::stable_sort(to_load_.begin(), to_load_.end(), [](const Chunk* a, const Chunk* b) {
    return a->firstRank() > b->firstRank();
  });
}

BagReader::~BagReader() = default;

void BagReader::addBag(const BagFile& file, const std::vector<std::string>& topics) {
  std::map<std::uint32_t, std::unique_ptr<Stream>> streams;
  for (const BagChunk& place : file.index.chunks) {
    auto chunk =
        std::make_unique<Chunk>(Chunk{&file, &place, chunks_.size(), {}, 0, false, false, {}});
    for (const auto& [number, begin, end] : place.parts) {
      const BagConnection& connection = file.index.connections.at(number);
      if (std::find(topics.begin(), topics.end(), connection.topic) == topics.end()) {
        continue;
      }
      chunk->parts.push_back(
          std::make_unique<Part>(Part{chunk.get(), number, rankOf(begin), {}, 0}));
      std::unique_ptr<Stream>& stream = streams[number];
      if (!stream) {
        stream = std::make_unique<Stream>(Stream{&connection, MessageRecords(number), {}});
      }
      stream->add(chunk->parts.back().get());
      const bool is_first = begin_.isZero();
      begin_ = is_first ? begin : std::min(begin_, begin);
      end_ = is_first ? end : std::max(end_, end);
    }
    if (!chunk->parts.empty()) {
      chunk->open_parts = chunk->parts.size();
      to_load_.push_back(chunk.get());
    }
    chunks_.push_back(std::move(chunk));
  }
  for (auto& [number, stream] : streams) {
    streams_.push_back(std::move(stream));
  }
}

/// As rosbag::View does before each message: it decides which of the same time comes first.
void BagReader::sort() {
  std::sort(running_.begin(), running_.end(), std::greater<>());
}

/// The same where all but the last are sorted. std::sort inserts one after the other where they are
/// few; of these only the last one moves.
void BagReader::sortLast() {
  constexpr std::size_t kFew = 16;
  if (running_.size() > kFew) {
    sort();
    return;
  }
  if (running_.empty()) {
    return;
  }
  const Running last = running_.back();
  auto place = running_.end() - 1;
  for (; place != running_.begin() && last > *(place - 1); --place) {
    *place = *(place - 1);
  }
  *place = last;
}

bool BagReader::next(BagMessage& message) {
  if (has_begun_) {
    advance();
  }
  has_begun_ = !running_.empty();
  if (!has_begun_) {
    return false;
  }
  Stream& stream = *running_.back().stream;
  Part& part = *stream.parts.front();
  try {
    makeReady(*part.chunk);
    if (part.entries.empty()) {
      part.chunk->readParts();
    }
    const BagEntry& entry = part.entries[part.next];
    message.connection = stream.connection;
    message.time = entry.time;
    message.data = stream.records.messageAt(part.chunk->records, entry.offset);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw unreadableBag(part.chunk->file->path, error);
  }
  return true;
}

void BagReader::advance() {
  Stream& stream = *running_.back().stream;
  Chunk& chunk = *stream.parts.front()->chunk;
  if (stream.advance() && --chunk.open_parts == 0) {
    release(chunk);
  }
  if (stream.parts.empty()) {
    running_.pop_back();
  } else {
    running_.back().rank = stream.parts.front()->rank;
  }
  sortLast();
}

/// Unpacked, and the one that was used last.
void BagReader::makeReady(Chunk& chunk) {
  if (!unpacked_.empty() && unpacked_.front() == &chunk) {
    return;
  }
  if (chunk.is_unpacked) {
    unpacked_.splice(
        unpacked_.begin(), unpacked_, std::find(unpacked_.begin(), unpacked_.end(), &chunk));
  } else {
    load(chunk);
  }
}

void BagReader::load(Chunk& chunk) {
  chunk.records = loader_.load(*chunk.file, *chunk.place);
  chunk.is_begun = true;
  chunk.is_unpacked = true;
  unpacked_.push_front(&chunk);
  keepFew();
  while (loader_.hasRoom() && !to_load_.empty()) {
    Chunk& next = *to_load_.back();
    to_load_.pop_back();
    if (!next.is_begun) {
      next.is_begun = true;
      loader_.begin(*next.file, *next.place);
    }
  }
}

/// Of those that are unpacked: the chunk at hand, and what there is room for.
void BagReader::keepFew() {
  std::size_t bytes = 0;
  for (auto it = unpacked_.begin(); it != unpacked_.end();) {
    Chunk& chunk = **it++;
    bytes += chunk.records.size();
    if (bytes > most_unpacked_ && &chunk != unpacked_.front()) {
      release(chunk);
    }
  }
}

void BagReader::release(Chunk& chunk) {
  chunk.is_unpacked = false;
  unpacked_.remove(&chunk);
  loader_.reuse(std::exchange(chunk.records, {}));
}

}  // namespace sac
