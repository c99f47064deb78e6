#include <ros/spinner.h>

#include "spherical_actuator_calibration/ros/calibration_node/calibration_node.hpp"
#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"

namespace {

/// Services take turns at the session, but a capture waits for measurements without holding it.
constexpr unsigned kServiceThreads = 4;

}  // namespace

int main(int argc, char** argv) {
  return sac::runNode(argc,
                      argv,
                      "calibration",
                      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                        sac::CalibrationNode calibration(
                            node,
                            private_node,
                            sac::loadDescriptionParameter(node),
                            sac::loadCalibrationNodeOptions(private_node));
                        ros::AsyncSpinner spinner(kServiceThreads);
                        spinner.start();
                        sac::waitForTermination();
                      });
}
