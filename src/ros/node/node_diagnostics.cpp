#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"

#include <exception>

#include <ros/console.h>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// How often the updater is asked, which keeps a longer period of its own [s].
constexpr double kAskingPeriod = 0.1;

}  // namespace

NodeDiagnostics::NodeDiagnostics(const ros::NodeHandle& node,
                                 const ros::NodeHandle& private_node,
                                 const Actuator& actuator)
    : updater_(node, private_node) {
  updater_.setHardwareID(actuator.serial.empty() ? actuator.name : actuator.serial);
  timer_ = node.createWallTimer(ros::WallDuration(kAskingPeriod),
                                [this](const ros::WallTimerEvent& /*event*/) { update(); });
}

void NodeDiagnostics::add(const std::string& name,
                          const std::function<void(DiagnosticStatus&)>& task) {
  updater_.add(name, task);
}

void NodeDiagnostics::update() {
  // A node lives on when what tells of it cannot: the ROS clock may stand at the end of its range.
  try {
    if (at_once_.exchange(false)) {
      updater_.force_update();
    } else {
      updater_.update();
    }
  } catch (const std::exception& error) {
    constexpr double kSilence = 10.0;  // [s]
    ROS_ERROR_STREAM_THROTTLE(kSilence, "Diagnostics cannot be published: " << error.what());
  }
}

void acceptDiagnosticPeriod(const YamlMap& parameters) {
  parameters.number("diagnostic_period", ValueRange::closed(0.01, 3600.0), 1.0);
}

void addTextOrNone(DiagnosticStatus& status, const std::string& key, const std::string& text) {
  status.add(key, text.empty() ? "none" : text);
}

}  // namespace sac
