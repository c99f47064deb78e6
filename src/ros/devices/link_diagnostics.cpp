#include "spherical_actuator_calibration/ros/devices/link_diagnostics.hpp"

#include <utility>

#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"

namespace sac {

LinkDiagnostics::LinkDiagnostics(std::string device)
    : DiagnosticTask("link"), device_(std::move(device)) {}

void LinkDiagnostics::update(const LinkSupervisor& link) {
  const std::lock_guard<std::mutex> lock(mutex_);
  link_ = link;
}

void LinkDiagnostics::run(DiagnosticStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (link_.isUp()) {
    status.summary(DiagnosticStatus::OK, "connected");
  } else {
    status.summary(DiagnosticStatus::ERROR,
                   link_.lastError().empty() ? "not connected yet" : link_.lastError());
  }
  status.add("device", device_);
  status.add("reconnects", link_.reconnects());
  status.add("failures", link_.failures());
  addTextOrNone(status, "last error", link_.lastError());
}

}  // namespace sac
