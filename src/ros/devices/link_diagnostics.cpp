#include "spherical_actuator_calibration/ros/devices/link_diagnostics.hpp"

#include <utility>

namespace sac {

LinkDiagnostics::LinkDiagnostics(std::string device)
    : DiagnosticTask("link"), device_(std::move(device)) {}

void LinkDiagnostics::update(const LinkSupervisor& link) {
  const std::lock_guard<std::mutex> lock(mutex_);
  link_ = link;
}

void LinkDiagnostics::run(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (link_.isUp()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "connected");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR,
                   link_.lastError().empty() ? "not connected yet" : link_.lastError());
  }
  status.add("device", device_);
  status.add("reconnects", link_.reconnects());
  status.add("failures", link_.failures());
  status.add("last error", link_.lastError().empty() ? "none" : link_.lastError());
}

}  // namespace sac
