#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bag_files.hpp"

namespace sac {

/// Reads and unpacks chunks, those that come next in a thread of its own while those at hand are
/// being used. Who has to wait for it helps. The bags outlive it.
class ChunkLoader {
 public:
  /// `most_ahead`: memory of the chunks that are begun before they are wanted [byte].
  explicit ChunkLoader(std::size_t most_ahead) : most_ahead_(most_ahead) {}
  ~ChunkLoader();
  ChunkLoader(const ChunkLoader&) = delete;
  ChunkLoader& operator=(const ChunkLoader&) = delete;

  /// The records of a chunk. Throws what unpacking it throws, also where it was begun before.
  std::string load(const BagFile& file, const BagChunk& chunk);
  /// Whether there is room to begin another one. With two, the thread has work while the first one
  /// is being taken.
  bool hasRoom() const { return begun_.size() < kMostBegun; }
  /// Begins a chunk that is wanted soon. Those that are too large are left to load().
  void begin(const BagFile& file, const BagChunk& chunk);
  /// Takes back memory that is not needed any more, for another chunk.
  void reuse(std::string records);

 private:
  static constexpr std::size_t kMostBegun = 2;

  using Task = std::packaged_task<std::string(Unpacker&)>;
  struct Begun {
    const BagChunk* chunk;
    std::future<std::string> records;
  };

  Task makeTask(const BagFile& file, const BagChunk& chunk);
  Task takeTask();
  bool hasThread();
  void run();

  std::size_t most_ahead_;
  std::vector<std::string> spare_;  ///< memory for records
  std::vector<Begun> begun_;
  Unpacker unpacker_;  ///< not of the thread, which has its own

  std::mutex mutex_;  ///< of what follows but for the thread
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace sac
