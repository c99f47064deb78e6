#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <spherical_actuator_calibration/CoilCurrents.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/devices/link_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"
#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"

namespace sac {

/// Reads the private parameters of a node (config/coil_driver.yaml). Throws ConfigError that names
/// the key.
CurrentAmplifierOptions loadCurrentAmplifierOptions(const ros::NodeHandle& private_node);

/// Follows `coil_command` within the limits and publishes the measured `coil_currents`. See
/// CoilDriver for when currents are zero; they are, too, when the node ends in any way but a kill,
/// which only the amplifier's own watchdog can answer.
class CoilDriverNode {
 public:
  /// Throws ConfigError when the description has no coils or the options are not valid.
  CoilDriverNode(const ros::NodeHandle& node,
                 const ros::NodeHandle& private_node,
                 const Actuator& actuator,
                 const CurrentAmplifierOptions& options,
                 std::unique_ptr<ModbusTransport> transport);
  ~CoilDriverNode();
  CoilDriverNode(const CoilDriverNode&) = delete;
  CoilDriverNode& operator=(const CoilDriverNode&) = delete;

 private:
  void receive(const msg::CoilCurrents::ConstPtr& message);
  void beat();
  void publish(const Eigen::VectorXd& currents, const ros::Time& stamp);
  void diagnoseOutput(DiagnosticStatus& status);

  const double watchdog_;
  std::unique_ptr<ModbusTransport> transport_;
  std::mutex mutex_;  ///< of what follows, down to setpoints_
  CoilDriver driver_;
  Eigen::VectorXd waiting_command_;  ///< not handed to the driver yet; empty: none
  double waiting_since_ = 0.0;
  std::string zero_reason_;
  bool fault_ = false;
  Eigen::VectorXd setpoints_;
  std::size_t clamped_ = 0;

  ros::Publisher publisher_;
  StreamMonitor commands_;
  StreamMonitor currents_;
  LinkDiagnostics link_diagnostics_;
  NodeDiagnostics diagnostics_;
  ros::Subscriber subscriber_;
  std::unique_ptr<PeriodicThread> thread_;  ///< last, so that it ends first
};

}  // namespace sac
