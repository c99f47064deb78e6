#include "spherical_actuator_calibration/ros/conversion/utc_date.hpp"

#include <ctime>

namespace sac {

std::string utcDate() {
  const std::time_t now = std::time(nullptr);
  std::tm utc = {};
  ::gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace sac
