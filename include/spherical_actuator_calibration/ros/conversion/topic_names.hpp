#pragma once

#include <string>

namespace sac {

/// What the names of all topics in a namespace begin with, however it is written: "actuator/",
/// "/actuator" → "/actuator/"; "/" → "/".
std::string topicPrefix(const std::string& ns);

}  // namespace sac
