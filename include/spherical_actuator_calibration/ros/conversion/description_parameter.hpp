#pragma once

#include <ros/node_handle.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"

namespace sac {

/// Reads the actuator description from the parameter `actuator` in the namespace of `node`. Throws
/// ConfigError when it is missing, or as parseDescription().
CalibratedDescription loadDescriptionParameter(const ros::NodeHandle& node);

/// The same for a node that reads joints: throws ConfigError also where the description
/// has no joints.
CalibratedDescription loadJointedDescriptionParameter(const ros::NodeHandle& node);

}  // namespace sac
