#pragma once

#include <optional>

#include "command_comparison.hpp"
#include "spherical_actuator_calibration/motion/motion_streams.hpp"

namespace sac {

/// Finds how the measured currents of a span follow what was commanded, by their changes, and adds
/// to each of them what they did between samples: by how much the mean of what follows, weighted
/// by a hat from the sample before to the one after, differs from its value at the stamp. Where
/// they do not follow, nothing is added; where they hardly do at all, nothing is told.
std::optional<CommandResponse> takeMeans(const CommandStream& commands, MotionStreams& streams);

}  // namespace sac
