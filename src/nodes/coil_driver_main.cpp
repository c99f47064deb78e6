#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/devices/coil_driver_node.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"

int main(int argc, char** argv) {
  return sac::runNode(
      argc,
      argv,
      "coil_driver",
      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
        const sac::CurrentAmplifierOptions options = sac::loadCurrentAmplifierOptions(private_node);
        const sac::CoilDriverNode coil_driver(node,
                                              private_node,
                                              sac::loadDescriptionParameter(node).actuator,
                                              options,
                                              sac::makeTransport(options.link));
        sac::spinUntilTermination();
      });
}
