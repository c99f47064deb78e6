#include <exception>

#include <ros/console.h>
#include <ros/init.h>

#include "spherical_actuator_calibration/ros/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/orientation_controller_node.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
  ros::init(argc, argv, "orientation_controller", ros::init_options::NoSigintHandler);
  // SIGTERM ends the loop below, so that the node's destructor commands zero.
  sac::handleTerminationSignals();
  // The last handle to go ends ROS, and with it the console that errors are told on.
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  try {
    const sac::OrientationControllerNode controller(
        node,
        private_node,
        sac::loadDescriptionParameter(node).actuator,
        sac::loadOrientationControllerOptions(private_node));
    sac::spinUntilTermination();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
