#pragma once

#include <string>

namespace sac {

/// Holds every length, count, position and offset of a bag (format 2.0) that rosbag's reader
/// believes against the bytes that are there, chunk by chunk: rosbag reads and allocates what they
/// say. Bags that were not closed pass: rosbag refuses them. Throws BagDefect (bag_records.hpp).
void verifyBag(const std::string& path);

}  // namespace sac
