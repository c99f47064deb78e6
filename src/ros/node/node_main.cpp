#include "spherical_actuator_calibration/ros/node/node_main.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include <ros/console.h>
#include <ros/exception.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <ros/service_manager.h>

#include "spherical_actuator_calibration/base/printable_text.hpp"
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

// roscpp waits for it by itself, but for no signal. False when one came first.
bool waitForMaster() {
  constexpr double kPeriod = 0.1;  // [s]
  bool is_told = false;
  while (!ros::master::check()) {
    if (!is_told) {
      ROS_WARN_STREAM("No ROS master answers at " << ros::master::getURI()
                                                  << " yet: roslaunch or roscore starts one.");
      is_told = true;
    }
    if (terminationRequested()) {
      return false;
    }
    ros::WallDuration(kPeriod).sleep();
  }
  return true;
}

// Each message that is logged, and each diagnosis, asks for one of these. roscpp remembers the
// answer, which the master tells again when it changes; the first time it waits for the master, for
// ever where that hangs, with a lock on all parameters: no control loop may be the first to ask.
void askForParametersOnce() {
  bool is_disabled = false;
  double period = 0.0;  // [s]
  static_cast<void>(ros::param::getCached("/rosout_disable_topics_generation", is_disabled));
  static_cast<void>(ros::param::getCached(ros::names::resolve("~diagnostic_period"), period));
}

// A name with a value in its place, such as description:=/a.yaml, renames something to no name.
bool initializeRos(int argc, char** argv, const char* name) {
  try {
    ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
    return true;
  } catch (const ros::Exception& error) {
    std::fprintf(stderr,
                 "%s: what an argument with := renames gets no valid name: %s. Parameters begin "
                 "with an underscore: _parameter:=value.\n",
                 name,
                 printable(error.what()).c_str());
    return false;
  }
}

// Private parameters outlive the node that they were given to, those that were misspelt, too.
// `message` is "namespace: key: sentence" where it is about one of them.
std::string adviceOn(const std::string& message, const ros::NodeHandle& private_node) {
  const std::string place = private_node.getNamespace() + ": ";
  if (message.rfind(place, 0) != 0) {
    return "";
  }
  const std::size_t end = message.find_first_of(":[", place.size());
  std::string key = message.substr(place.size(), end - place.size());
  std::replace(key.begin(), key.end(), '.', '/');
  std::string reason;
  if (key.empty() || !ros::names::validate(key, reason) || !private_node.hasParam(key)) {
    return "";
  }
  return " It stays on the parameter server until it is taken away: rosparam delete " +
         private_node.resolveName(key);
}

}  // namespace

int runNode(int argc,
            char** argv,
            const char* name,
            const std::function<void(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node)>& body) {
  for (int n = 1; n < argc; ++n) {
    const std::string word = argv[n];
    if (word == "--help" || word == "-h") {
      std::printf(
          "Usage: %s [_parameter:=value...] [topic:=name...] [__ns:=namespace]\n\n"
          "A node: its parameters, topics and services are in doc/interfaces.md, and launch/ "
          "starts it with\nthose of config/.\n",
          name);
      return 0;
    }
  }
  if (!initializeRos(argc, argv, name)) {
    return 1;
  }
  handleTerminationSignals();
  endStartAfterSignal();
  if (!waitForMaster()) {
    return 0;
  }
  // The last handle to go ends ROS, and with it the console that errors are told on.
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  withdrawLoggerServices();
  askForParametersOnce();
  try {
    body(node, private_node);
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what() << adviceOn(error.what(), private_node));
    return 1;
  }
  return 0;
}

}  // namespace sac
