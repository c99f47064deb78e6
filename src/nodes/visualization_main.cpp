#include <exception>

#include <ros/console.h>
#include <ros/init.h>

#include "spherical_actuator_calibration/ros/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"
#include "spherical_actuator_calibration/ros/visualization_node.hpp"

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
  ros::init(argc, argv, "visualization", ros::init_options::NoSigintHandler);
  sac::handleTerminationSignals();
  // The last handle to go ends ROS, and with it the console that errors are told on.
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  try {
    const sac::VisualizationNode visualization(node,
                                               private_node,
                                               sac::loadDescriptionParameter(node).actuator,
                                               sac::loadVisualizationOptions(private_node));
    sac::spinUntilTermination();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
