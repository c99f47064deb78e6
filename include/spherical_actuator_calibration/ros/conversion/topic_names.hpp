#pragma once

#include <string>

namespace sac {

// What the calibration node says of its session, as std_msgs/String, so that a recording does.
inline constexpr char kDescriptionTopic[] = "calibration_description";  ///< description file (YAML)
inline constexpr char kConfigTopic[] = "calibration_config";  ///< configuration file (YAML)

/// What the names of all topics in a namespace begin with, however it is written: "actuator/",
/// "/actuator" → "/actuator/"; "/" → "/".
std::string topicPrefix(const std::string& ns);

}  // namespace sac
