#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/emulation_node/lab_emulator_node.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

int main(int argc, char** argv) {
  sac::askForRealTime();
  return sac::runNode(argc,
                      argv,
                      "lab_emulator",
                      [](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
                        const sac::LabEmulatorNode emulator(
                            node,
                            private_node,
                            sac::loadDescriptionParameter(node).actuator,
                            sac::loadLabEmulatorOptions(private_node));
                        sac::spinUntilTermination();
                      });
}
