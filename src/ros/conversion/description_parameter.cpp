#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"

#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"

namespace sac {

CalibratedDescription loadDescriptionParameter(const ros::NodeHandle& node) {
  return readDescription(requiredParameters(node, "actuator"));
}

}  // namespace sac
