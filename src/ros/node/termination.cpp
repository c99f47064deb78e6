#include "spherical_actuator_calibration/ros/node/termination.hpp"

#include <csignal>

#include <ros/callback_queue.h>
#include <ros/init.h>

namespace sac {
namespace {

volatile std::sig_atomic_t g_termination_requested = 0;

void requestTermination(int /*signal*/) {
  g_termination_requested = 1;
}

// How long a signal may wait when no callback is due [s].
constexpr double kPatience = 0.02;

}  // namespace

void handleTerminationSignals() {
  struct sigaction action = {};
  action.sa_handler = requestTermination;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool terminationRequested() {
  return g_termination_requested != 0;
}

void spinUntilTermination() {
  while (ros::ok() && !terminationRequested()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kPatience));
  }
}

void waitForTermination() {
  while (ros::ok() && !terminationRequested()) {
    ros::WallDuration(kPatience).sleep();
  }
}

}  // namespace sac
