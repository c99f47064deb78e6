#include "spherical_actuator_calibration/ros/recording/open_recordings.hpp"

#include "bag_files.hpp"

namespace sac {

OpenRecordings::OpenRecordings(const std::vector<std::string>& paths) : bags_(openBags(paths)) {}

OpenRecordings::~OpenRecordings() = default;

}  // namespace sac
