#include "chunk_loader.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

namespace sac {

ChunkLoader::~ChunkLoader() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

std::string ChunkLoader::load(const BagFile& file, const BagChunk& chunk) {
  const auto begun = std::find_if(
      begun_.begin(), begun_.end(), [&](const Begun& other) { return other.chunk == &chunk; });
  if (begun == begun_.end()) {
    Task task = makeTask(file, chunk);
    task(unpacker_);
    return task.get_future().get();
  }
  std::future<std::string> records = std::move(begun->records);
  begun_.erase(begun);
  // Rather than to wait for the other thread, what it has not come to is done here.
  while (records.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    Task task = takeTask();
    if (!task.valid()) {
      break;
    }
    task(unpacker_);
  }
  return records.get();
}

void ChunkLoader::begin(const BagFile& file, const BagChunk& chunk) {
  if (chunk.size > most_ahead_ / kMostBegun || !hasThread()) {
    return;
  }
  Task task = makeTask(file, chunk);
  begun_.push_back({&chunk, task.get_future()});
  const std::lock_guard<std::mutex> lock(mutex_);
  tasks_.push_back(std::move(task));
  changed_.notify_one();
}

void ChunkLoader::reuse(std::string records) {
  if (spare_.size() < kMostBegun && records.capacity() <= most_ahead_ / kMostBegun) {
    spare_.push_back(std::move(records));
  }
}

ChunkLoader::Task ChunkLoader::makeTask(const BagFile& file, const BagChunk& chunk) {
  std::string buffer;
  if (!spare_.empty()) {
    buffer = std::move(spare_.back());
    spare_.pop_back();
  }
  return Task([&file, &chunk, records = std::move(buffer)](Unpacker& unpacker) mutable {
    unpacker.unpack(file.bytes, chunk.position, records);
    return std::move(records);
  });
}

/// Not valid where there is none.
ChunkLoader::Task ChunkLoader::takeTask() {
  const std::lock_guard<std::mutex> lock(mutex_);
  Task task;
  if (!tasks_.empty()) {
    task = std::move(tasks_.front());
    tasks_.pop_front();
  }
  return task;
}

/// Starts it where there is none yet. A recording of one chunk needs none.
bool ChunkLoader::hasThread() {
  if (!thread_.joinable()) {
    try {
      thread_ = std::thread([this] { run(); });
    } catch (const std::system_error&) {
      return false;  // there is none to be had: chunks are unpacked when they are wanted
    }
  }
  return true;
}

void ChunkLoader::run() {
  Unpacker unpacker;
  while (true) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
      if (ends_) {
        return;
      }
    }
    Task task = takeTask();
    if (task.valid()) {
      task(unpacker);
    }
  }
}

}  // namespace sac
