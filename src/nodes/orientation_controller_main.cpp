#include "spherical_actuator_calibration/ros/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/node_main.hpp"
#include "spherical_actuator_calibration/ros/orientation_controller_node.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
  return sac::runNode(argc,
                      argv,
                      "orientation_controller",
                      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                        const sac::Actuator design = sac::loadDescriptionParameter(node).actuator;
                        const sac::OrientationControllerNode controller(
                            node,
                            private_node,
                            design,
                            sac::loadOrientationControllerOptions(private_node, design));
                        sac::spinUntilTermination();
                      });
}
