#pragma once

#include <functional>

#include <ros/node_handle.h>

namespace sac {

/// The main function of a node: starts ROS under `name`, makes SIGINT and SIGTERM end the loops of
/// termination.hpp, so that the node's objects are destroyed in order (a driver's destructor sets
/// its currents to zero), and runs `body` with the public and the private handle. Before there is a
/// master these signals end it, too, and --help needs none. Returns the exit status: 1, with the
/// message on the console, when the body throws.
int runNode(int argc,
            char** argv,
            const char* name,
            const std::function<void(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node)>& body);

}  // namespace sac
