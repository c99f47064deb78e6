#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/devices/tracker_bridge_node.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"

int main(int argc, char** argv) {
  return sac::runNode(argc,
                      argv,
                      "tracker_bridge",
                      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                        const sac::TrackerBridgeNode tracker_bridge(
                            node,
                            private_node,
                            sac::loadDescriptionParameter(node).actuator,
                            sac::readTrackerBridgeOptions(sac::privateParameters(private_node)));
                        sac::spinUntilTermination();
                      });
}
