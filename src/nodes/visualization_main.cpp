#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/view/visualization_node.hpp"

int main(int argc, char** argv) {
  return sac::runNode(argc,
                      argv,
                      "visualization",
                      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                        const sac::VisualizationNode visualization(
                            node,
                            private_node,
                            sac::loadDescriptionParameter(node).actuator,
                            sac::loadVisualizationOptions(private_node));
                        sac::spinUntilTermination();
                      });
}
