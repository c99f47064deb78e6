#include "spherical_actuator_calibration/ros/node/node_main.hpp"

#include <exception>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/service_manager.h>

#include "spherical_actuator_calibration/ros/node/termination.hpp"

namespace sac {
namespace {

// roscpp offers these services to everybody. Where rosconsole is built with log4cxx 1.0, as Debian
// has it, the answer to the first frees what log4cxx goes on to use: two calls end the node by
// SIGSEGV. The second keeps each name that it is given, of any length, until the node ends;
// programs that set levels ask for the loggers first.
void withdrawLoggerServices() {
  for (const char* const service : {"~get_loggers", "~set_logger_level"}) {
    ros::ServiceManager::instance()->unadvertiseService(ros::names::resolve(service));
  }
}

}  // namespace

int runNode(int argc,
            char** argv,
            const char* name,
            const std::function<void(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node)>& body) {
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  handleTerminationSignals();
  // The last handle to go ends ROS, and with it the console that errors are told on.
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  withdrawLoggerServices();
  try {
    body(node, private_node);
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}

}  // namespace sac
