#include "spherical_actuator_calibration/ros/controller/orientation_controller_node.hpp"
#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

int main(int argc, char** argv) {
  sac::askForRealTime();
  return sac::runNode(
      argc,
      argv,
      "orientation_controller",
      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
        const sac::Actuator design = sac::loadDescriptionParameter(node).actuator;
        const sac::OrientationControllerNode controller(
            node,
            private_node,
            design,
            sac::readOrientationControllerOptions(sac::privateParameters(private_node), design));
        sac::spinUntilTermination();
      });
}
