#pragma once

#include <memory>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/JointState.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/drivers/joint_sensor.hpp"
#include "spherical_actuator_calibration/drivers/link_supervisor.hpp"
#include "spherical_actuator_calibration/ros/devices/link_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/loop_timing.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"
#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"

namespace sac {

/// Reads the private parameters of a node (config/joint_sensor.yaml). Throws ConfigError that names
/// the key.
JointSensorOptions loadJointSensorOptions(const ros::NodeHandle& private_node);

/// Polls the joint sensors and publishes `joint_states`: raw sensor angles [rad], stamped with the
/// middle of the requests. While a device is lost nothing is published, an error stands on
/// /diagnostics, and it is tried again with growing pauses.
class JointSensorNode {
 public:
  /// `actuator` gives the names of the joints, and the serial number for /diagnostics.
  JointSensorNode(const ros::NodeHandle& node,
                  const ros::NodeHandle& private_node,
                  const Actuator& actuator,
                  const JointSensorOptions& options,
                  std::unique_ptr<ModbusTransport> transport);
  JointSensorNode(const JointSensorNode&) = delete;
  JointSensorNode& operator=(const JointSensorNode&) = delete;

 private:
  void poll();
  /// Returns its age when it is published [s].
  double publishReading();

  std::unique_ptr<ModbusTransport> transport_;
  JointSensor sensor_;
  LinkSupervisor link_;
  sensor_msgs::JointState message_;
  ros::Publisher publisher_;
  StreamMonitor stream_;
  TimingDiagnostics timing_;
  LinkDiagnostics link_diagnostics_;
  NodeDiagnostics diagnostics_;
  std::unique_ptr<PeriodicThread> thread_;  ///< last, so that it ends first
};

}  // namespace sac
