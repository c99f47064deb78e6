#include "bag_files.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <new>
#include <set>
#include <system_error>
#include <utility>

#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

/// Parts of a recording may overlap by what waited in the recorder's queue.
constexpr double kSplitOverlap = 0.5;  // [s]

void requireReadableFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw DataError(path + ": there is no such file.");
  }
  if (!fs::is_regular_file(status)) {
    throw DataError(path + ": is not a file; give a recording (.bag).");
  }
  if (fs::file_size(path, error) == 0) {
    throw DataError(path + ": the file is empty; record again.");
  }
}

/// Topics in the order of their first connections. Precondition: the index is there.
void readTopics(BagFile& file) {
  std::map<std::uint32_t, ChunkPart> spans;
  for (const BagChunk& chunk : file.index.chunks) {
    for (const ChunkPart& part : chunk.parts) {
      ChunkPart& span = spans.try_emplace(part.connection, part).first->second;
      span.begin = std::min(span.begin, part.begin);
      span.end = std::max(span.end, part.end);
    }
  }
  for (const auto& [number, span] : spans) {
    const BagConnection& connection = file.index.connections.at(number);
    const auto known =
        std::find_if(file.topics.begin(), file.topics.end(), [&](const BagTopic& topic) {
          return topic.name == connection.topic;
        });
    if (known == file.topics.end()) {
      file.topics.push_back(
          {connection.topic, connection.datatype, connection.md5sum, span.begin, span.end});
    } else {
      known->begin = std::min(known->begin, span.begin);
      known->end = std::max(known->end, span.end);
    }
    const bool is_first = number == spans.begin()->first;
    file.begin = is_first ? span.begin : std::min(file.begin, span.begin);
    file.end = is_first ? span.end : std::max(file.end, span.end);
  }
}

std::unique_ptr<BagFile> openBag(const std::string& path) {
  requireReadableFile(path);
  std::unique_ptr<BagFile> file;
  try {
    file = std::make_unique<BagFile>(path);
    file->index = readBagIndex(file->bytes);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw unreadableBag(path, error);
  }
  if (!file->index.is_complete) {
    throw DataError(path + ": the recording was not closed and has no index; run `rosbag reindex " +
                    path + "` and try again.");
  }
  readTopics(*file);
  if (file->topics.empty()) {
    throw DataError(path + ": the bag holds no messages; record again.");
  }
  return file;
}

bool isSideBySide(const BagFile& file, const BagFile& other, const std::string& prefix) {
  for (const BagTopic& topic : file.topics) {
    if (topic.name.compare(0, prefix.size(), prefix) != 0) {
      continue;
    }
    for (const BagTopic& same : other.topics) {
      if (same.name == topic.name && secondsBetween(topic.begin, same.end) > kSplitOverlap &&
          secondsBetween(same.begin, topic.end) > kSplitOverlap) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

DataError unreadableBag(const std::string& path, const std::exception& reason) {
  return DataError(path + ": cannot be read as a bag (" + reason.what() +
                   "); copy it again, or rescue what is in it by `rosbag reindex " + path + "`.");
}

std::vector<std::unique_ptr<BagFile>> openBags(const std::vector<std::string>& paths) {
  std::vector<std::unique_ptr<BagFile>> bags;
  std::set<std::string> known;
  for (const std::string& path : paths) {
    bags.push_back(openBag(path));
    // Without a canonical name, as of a file that was removed meanwhile, it is the same by its own.
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    if (!known.insert(error ? path : canonical.string()).second) {
      throw DataError(path + ": is given twice.");
    }
  }
  return bags;
}

std::vector<BagGroup> groupBags(const std::vector<std::unique_ptr<BagFile>>& bags,
                                const std::string& prefix) {
  std::vector<BagFile*> sorted;
  sorted.reserve(bags.size());
  for (const auto& bag : bags) {
    sorted.push_back(bag.get());
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const BagFile* a, const BagFile* b) {
    return a->begin < b->begin;
  });
  std::vector<BagGroup> groups;
  for (BagFile* file : sorted) {
    const bool fits =
        !groups.empty() &&
        std::all_of(groups.back().begin(), groups.back().end(), [&](const BagFile* other) {
          return isSideBySide(*file, *other, prefix);
        });
    if (!fits) {
      groups.emplace_back();
    }
    groups.back().push_back(file);
  }
  return groups;
}

}  // namespace sac
