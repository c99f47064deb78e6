#pragma once

#include <mutex>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>

#include "spherical_actuator_calibration/drivers/link_supervisor.hpp"

namespace sac {

/// State of a device's link for /diagnostics, handed from the thread that serves the device to the
/// one that reports. An error as soon as the link is lost.
class LinkDiagnostics : public diagnostic_updater::DiagnosticTask {
 public:
  /// `device`: address for people.
  explicit LinkDiagnostics(std::string device);

  void update(const LinkSupervisor& link);
  void run(diagnostic_updater::DiagnosticStatusWrapper& status) override;

 private:
  std::string device_;
  std::mutex mutex_;
  LinkSupervisor link_;
};

}  // namespace sac
