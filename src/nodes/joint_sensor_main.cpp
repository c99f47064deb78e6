#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/devices/joint_sensor_node.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

int main(int argc, char** argv) {
  sac::askForRealTime();
  return sac::runNode(
      argc,
      argv,
      "joint_sensor",
      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
        const sac::JointSensorOptions options = sac::loadJointSensorOptions(private_node);
        const sac::JointSensorNode joint_sensor(node,
                                                private_node,
                                                sac::loadJointedDescriptionParameter(node).actuator,
                                                options,
                                                sac::makeTransport(options.link));
        sac::spinUntilTermination();
      });
}
