#include "spherical_actuator_calibration/ros/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/node_main.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"
#include "spherical_actuator_calibration/ros/visualization_node.hpp"

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
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
