#pragma once

#include <memory>
#include <string>

#include <rosbag/bag.h>

namespace sac {

/// Closes a bag, and says why it could not be closed: a full disk, say. Empty where it could.
/// rosbag::Bag throws in its destructor when it cannot be closed, which ends the program: such a
/// bag is given up instead, and its file stays without an index.
std::string closeBag(std::unique_ptr<rosbag::Bag>& bag);

}  // namespace sac
