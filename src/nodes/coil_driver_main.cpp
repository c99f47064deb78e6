#include <exception>

#include <ros/console.h>
#include <ros/init.h>

#include "spherical_actuator_calibration/ros/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/coil_driver_node.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
  ros::init(argc, argv, "coil_driver", ros::init_options::NoSigintHandler);
  // SIGTERM ends the loop below, so that the driver's destructor sets the currents to zero.
  sac::handleTerminationSignals();
  // The last handle to go ends ROS, and with it the console that errors are told on.
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  try {
    const sac::CurrentAmplifierOptions options = sac::loadCurrentAmplifierOptions(private_node);
    const sac::CoilDriverNode coil_driver(node,
                                          private_node,
                                          sac::loadDescriptionParameter(node).actuator,
                                          options,
                                          sac::makeTransport(options.link));
    sac::spinUntilTermination();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
