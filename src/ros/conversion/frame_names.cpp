#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"

namespace sac {

bool isFrame(const std::string& frame_id, const std::string& frame) {
  return frame_id == frame || (!frame_id.empty() && frame_id.front() == '/' &&
                               frame_id.compare(1, std::string::npos, frame) == 0);
}

std::string otherFrame(const std::string& frame_id, const std::string& frame) {
  return "is in the frame \"" + frame_id + "\", not in \"" + frame + "\"";
}

}  // namespace sac
