#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <ros/time.h>

#include "bag_files.hpp"
#include "chunk_loader.hpp"

namespace sac {

/// Messages between two calls of the progress function.
inline constexpr std::uint64_t kProgressStep = 4096;

/// One message as it was recorded.
struct BagMessage {
  const BagConnection* connection = nullptr;
  ros::Time time;         ///< when it was recorded
  std::string_view data;  ///< serialised; valid until the next message is read
};

/// Hands out messages of chosen topics in the order in which rosbag::View would, also those of the
/// same time, but reads each chunk once and keeps no index of all messages: memory does not grow
/// with their number, but with that of chunks. Chunks that overlap in time are unpacked at the same
/// time, as long as they are few. The next ones are unpacked by another thread meanwhile.
class BagReader {
 public:
  /// The bags outlive the reader.
  /// `most_unpacked`: bytes of chunks that are kept unpacked beside the one at hand, and of those
  /// that are unpacked ahead. The default is some forty chunks as rosbag makes them.
  BagReader(const BagGroup& bags,
            const std::vector<std::string>& topics,
            std::size_t most_unpacked = kMostUnpacked);
  ~BagReader();
  BagReader(const BagReader&) = delete;
  BagReader& operator=(const BagReader&) = delete;

  /// Of the chosen messages; zero where there is none.
  ros::Time begin() const { return begin_; }
  ros::Time end() const { return end_; }

  /// Reads the next message; false after the last one. Throws DataError, naming the file, when it
  /// cannot be read.
  bool next(BagMessage& message);

 private:
  static constexpr std::size_t kMostUnpacked = std::size_t{32} << 20U;

  struct Chunk;
  struct Part;
  struct Stream;
  /// A stream, and the rank of its next message.
  struct Running {
    std::uint64_t rank;
    Stream* stream;

    bool operator>(const Running& other) const { return rank > other.rank; }
  };

  void addBag(const BagFile& file, const std::vector<std::string>& topics);
  void sort();
  void sortLast();
  void advance();
  void makeReady(Chunk& chunk);
  void load(Chunk& chunk);
  void release(Chunk& chunk);
  void keepFew();

  std::size_t most_unpacked_;
  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::vector<std::unique_ptr<Stream>> streams_;
  std::vector<Running> running_;  ///< those that are not over, the next one last
  std::list<Chunk*> unpacked_;    ///< the one used last comes first
  std::vector<Chunk*> to_load_;   ///< not begun yet, the one that is wanted next last
  ChunkLoader loader_;
  bool has_begun_ = false;
  ros::Time begin_;
  ros::Time end_;
};

}  // namespace sac
