#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <ros/time.h>

#include "bag_index.hpp"
#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {

/// A topic of which a bag holds messages.
struct BagTopic {
  std::string name;
  std::string datatype;  ///< "geometry_msgs/Vector3Stamped"
  std::string md5sum;    ///< of the message definition
  ros::Time begin;       ///< when its first message was recorded
  ros::Time end;         ///< when its last message was recorded
};

/// A bag that is open for reading.
struct BagFile {
  explicit BagFile(const std::string& name) : path(name), bytes(name) {}

  std::string path;
  FileBytes bytes;
  BagIndex index;
  std::vector<BagTopic> topics;
  ros::Time begin;  ///< of all topics
  ros::Time end;    ///< of all topics
};

/// Says what to do about a bag that cannot be read for a reason.
DataError unreadableBag(const std::string& path, const std::exception& reason);

/// Opens bags and reads their indexes. Throws DataError, naming the file and what to do about it,
/// for a file that is missing, no bag, not indexed, damaged or without messages.
std::vector<std::unique_ptr<BagFile>> openBags(const std::vector<std::string>& paths);

/// Bags whose messages can be read as one stream.
using BagGroup = std::vector<BagFile*>;

/// Sorts bags by their begin, and groups them: parts of one recording (one after the other, or
/// topics recorded side by side) belong together. A bag that holds a topic at the same time as the
/// group before it is another session with the same clock, and begins a group of its own. Only
/// topics whose name begins with `prefix` count.
std::vector<BagGroup> groupBags(const std::vector<std::unique_ptr<BagFile>>& bags,
                                const std::string& prefix);

}  // namespace sac
