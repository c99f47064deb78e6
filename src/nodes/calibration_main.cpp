#include <exception>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/spinner.h>

#include "spherical_actuator_calibration/ros/calibration_node.hpp"
#include "spherical_actuator_calibration/ros/termination.hpp"

namespace {

/// Services take turns at the session, but a capture waits for measurements without holding it.
constexpr unsigned kServiceThreads = 4;

}  // namespace

int main(int argc, char** argv) {
  namespace sac = spherical_actuator_calibration;
  ros::init(argc, argv, "calibration", ros::init_options::NoSigintHandler);
  sac::handleTerminationSignals();
  // The last handle to go ends ROS, and with it the console that errors are told on.
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  try {
    sac::CalibrationNode calibration(node,
                                     private_node,
                                     sac::loadDescriptionParameter(node),
                                     sac::loadCalibrationNodeOptions(private_node));
    ros::AsyncSpinner spinner(kServiceThreads);
    spinner.start();
    sac::waitForTermination();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
