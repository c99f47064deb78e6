#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"

namespace sac {

CalibratedDescription loadDescriptionParameter(const ros::NodeHandle& node) {
  return readDescription(requiredParameters(node, "actuator"));
}

CalibratedDescription loadJointedDescriptionParameter(const ros::NodeHandle& node) {
  CalibratedDescription description = loadDescriptionParameter(node);
  if (!description.actuator.has_joints) {
    throw ConfigError("The description of " + description.actuator.name +
                      " has no joints, and this node reads them: leave it out, as lab.launch does "
                      "with joint_sensor:=false. The tracker tells the orientation.");
  }
  return description;
}

}  // namespace sac
