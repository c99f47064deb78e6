#include <string>

#include <ros/console.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include "spherical_actuator_calibration/ActuatorParameters.h"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/node/latched_publishing.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"

namespace {

using Message = sac::msg::ActuatorParameters;

Message messageOf(const sac::CalibratedDescription& description, const std::string& frame) {
  Message message = sac::parametersToRos(description.actuator, description.stddevs);
  message.header.stamp = ros::Time::now();
  message.header.frame_id = frame;
  message.revision = description.calibration ? description.calibration->revision : 0;
  message.source = description.calibration ? Message::IDENTIFIED : Message::NOMINAL;
  return message;
}

/// Private parameters: `description`, the file; `frame`, that of the stator.
void publish(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  const sac::YamlMap map = sac::privateParameters(private_node);
  const std::string path = map.nonEmptyText("description");
  const std::string frame = map.text("frame", "stator");
  map.finish();
  const sac::CalibratedDescription description = sac::loadDescription(path);
  if (sac::isContradicted(description)) {
    ROS_WARN(
        "%s was contradicted by what was held out when it was made: do not use it, calibrate anew.",
        path.c_str());
  }
  const Message message = messageOf(description, frame);
  constexpr bool kLatched = true;
  ros::NodeHandle advertising = node;
  const ros::Publisher publisher = advertising.advertise<Message>("parameters", 1, kLatched);
  sac::publishLatched(publisher, message);
  sac::spinUntilTermination();
}

}  // namespace

/// Makes the parameters of a calibrated description those in force, where no calibration node runs.
int main(int argc, char** argv) {
  return sac::runNode(argc, argv, "publish_parameters", publish);
}
