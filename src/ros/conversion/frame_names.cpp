#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"

#include <cstddef>

#include "spherical_actuator_calibration/base/printable_text.hpp"

namespace sac {

bool isFrame(const std::string& frame_id, const std::string& frame) {
  return frame_id == frame || (!frame_id.empty() && frame_id.front() == '/' &&
                               frame_id.compare(1, std::string::npos, frame) == 0);
}

std::string otherFrame(const std::string& frame_id, const std::string& frame) {
  // The name comes from another node: it may be anything, and of any length.
  constexpr std::size_t kShown = 200;
  return "is in the frame \"" + printable(frame_id.substr(0, kShown)) + "\", not in \"" + frame +
         "\"";
}

}  // namespace sac
