#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "spherical_actuator_calibration/PosePatterns.h"
#include "spherical_actuator_calibration/PoseProgress.h"
#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"
#include "spherical_actuator_calibration/planning/pose_progress.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// Coils that are excited at once, by their numbers, negative where the current is. Throws
/// ConfigError where an actuator with so many coils has no such, or they do not ascend.
CoilPattern patternFromRos(const std::vector<std::int32_t>& signed_numbers, std::size_t coils);

msg::CoilPattern patternToRos(const CoilPattern& pattern);

/// Likewise; each pattern has a coil.
PoseToMeasure poseFromRos(const msg::PosePatterns& message, std::size_t coils);
msg::PosePatterns poseToRos(const PoseToMeasure& pose);

/// Of one pose of a plan, or of all in their order.
msg::PoseProgress progressToRos(const PoseProgress& progress);
std::vector<msg::PoseProgress> progressToRos(const std::vector<PoseProgress>& poses);

}  // namespace sac
