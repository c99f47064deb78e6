#include "spherical_actuator_calibration/ros/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/coil_driver_node.hpp"
#include "spherical_actuator_calibration/ros/node_main.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
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
