#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <ros/time.h>

#include "bag_source.hpp"

namespace sac {

/// Who wrote messages of a topic.
struct BagConnection {
  std::string topic;
  std::string datatype;  ///< "geometry_msgs/Vector3Stamped"
  std::string md5sum;    ///< of the message definition
};

/// A stamp as a number: stamps and their numbers have the same order. To compare those of ros::Time
/// takes a call.
inline std::uint64_t rankOf(const ros::Time& time) {
  constexpr unsigned kSecondBits = 32;
  return std::uint64_t{time.sec} << kSecondBits | time.nsec;
}

/// Where a message is within a chunk that is unpacked, and when it was recorded.
struct BagEntry {
  ros::Time time;
  std::uint32_t offset = 0;
};

/// The messages of one connection in one chunk.
struct ChunkPart {
  std::uint32_t connection = 0;
  ros::Time begin;
  ros::Time end;
};

struct BagChunk {
  std::uint64_t position = 0;       ///< in the file
  std::uint64_t end = 0;            ///< in the file
  std::uint64_t size = 0;           ///< as it is packed, and unpacked beside it [byte]
  std::uint32_t index_records = 0;  ///< that follow it
  std::vector<ChunkPart> parts;
};

/// What a bag says of what it holds, checked as far as that is possible without unpacking. Grows
/// with the number of chunks, not of messages.
struct BagIndex {
  bool is_complete = false;  ///< false: the bag was not closed, and the rest is empty
  std::map<std::uint32_t, BagConnection> connections;  ///< by their numbers
  std::vector<BagChunk> chunks;                        ///< in the order in which the bag lists them
};

/// Throws BagDefect when something does not fit.
BagIndex readBagIndex(const FileBytes& file);

/// Messages by the number of their connection.
using BagEntries = std::map<std::uint32_t, std::vector<BagEntry>>;

/// Messages of each connection by the index records that begin at a position, in the order in which
/// they stand there; what rosbag::View never hands out (times of zero) is left out.
BagEntries readEntries(const FileBytes& file, std::uint64_t position, std::uint32_t records);

}  // namespace sac
