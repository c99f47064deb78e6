#pragma once

#include <atomic>
#include <functional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"

namespace sac {

using DiagnosticStatus = diagnostic_updater::DiagnosticStatusWrapper;

/// What a node tells on /diagnostics: one status per task, each `diagnostic_period` (a private
/// parameter, 1 s), by the global callback queue. The hardware is the unit, by its serial number
/// or, where it has none, by the name of the actuator.
class NodeDiagnostics {
 public:
  NodeDiagnostics(const ros::NodeHandle& node,
                  const ros::NodeHandle& private_node,
                  const Actuator& actuator);
  NodeDiagnostics(const NodeDiagnostics&) = delete;
  NodeDiagnostics& operator=(const NodeDiagnostics&) = delete;

  /// Tasks live as long as this object does, and are run by one thread at a time.
  void add(diagnostic_updater::DiagnosticTask& task) { updater_.add(task); }
  void add(const std::string& name, const std::function<void(DiagnosticStatus&)>& task);

  /// Something changed that cannot wait for the period to end. Thread-safe.
  void tellAtOnce() { at_once_ = true; }

 private:
  void update();

  diagnostic_updater::Updater updater_;
  std::atomic<bool> at_once_{false};
  ros::WallTimer timer_;
};

/// Accepts the key `diagnostic_period` of a node's parameters, which diagnostic_updater reads by
/// itself. Throws ConfigError when it is out of range.
void acceptDiagnosticPeriod(const YamlMap& parameters);

/// Adds a text to a status; "none" where it is empty.
void addTextOrNone(DiagnosticStatus& status, const std::string& key, const std::string& text);

}  // namespace sac
