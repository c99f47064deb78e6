#include "spherical_actuator_calibration/ros/calibration_node_options.hpp"
#include "spherical_actuator_calibration/ros/node_main.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"
#include "spherical_actuator_calibration/ros/tracker_bridge_node.hpp"

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
  return sac::runNode(argc,
                      argv,
                      "tracker_bridge",
                      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                        const sac::TrackerBridgeNode tracker_bridge(
                            node,
                            private_node,
                            sac::loadDescriptionParameter(node).actuator,
                            sac::loadTrackerBridgeOptions(private_node));
                        sac::spinUntilTermination();
                      });
}
