#include "spherical_actuator_calibration/ros/recording/bag_closing.hpp"

#include <exception>

namespace sac {

std::string closeBag(std::unique_ptr<rosbag::Bag>& bag) {
  if (!bag) {
    return "";
  }
  try {
    bag->close();
  } catch (const std::exception& error) {
    [[maybe_unused]] const rosbag::Bag* const leaked = bag.release();
    return error.what();
  }
  bag.reset();
  return "";
}

}  // namespace sac
