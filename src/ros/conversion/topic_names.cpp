#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"

namespace sac {

std::string topicPrefix(const std::string& ns) {
  const std::size_t first = ns.find_first_not_of('/');
  if (first == std::string::npos) {
    return "/";
  }
  return "/" + ns.substr(first, ns.find_last_not_of('/') + 1 - first) + "/";
}

}  // namespace sac
