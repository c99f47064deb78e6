#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <spherical_actuator_calibration/CoilCurrents.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/drivers/coil_driver.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/devices/link_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/devices/zero_watch.hpp"
#include "spherical_actuator_calibration/ros/node/loop_timing.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"
#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"

namespace sac {

struct MessageSender;

/// Reads the private parameters of a node (config/coil_driver.yaml). Throws ConfigError that names
/// the key.
CurrentAmplifierOptions loadCurrentAmplifierOptions(const ros::NodeHandle& private_node);

/// Follows `coil_command` within the limits and publishes the measured `coil_currents`, and where
/// somebody listens what it has set, `coil_setpoints`, stamped when it did: a command
/// that counts is set as soon as it comes, see PeriodicThread::wake(). See
/// CoilDriver for when currents are zero; they are, too, when the node ends in any way but a kill,
/// which only the amplifier's own watchdog can answer. Commands are judged by the wall clock, even
/// where /use_sim_time is set: coils are real.
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

  /// Sets the currents to zero and ends the control loop, for good. True when all went well: the
  /// loop had not failed, zero was confirmed since anything else was set or measured, and no
  /// deviation of currents stands. What is dangerous is told on the console.
  bool stop();
  /// After stop(): goes on measuring while this object, and ROS, end.
  std::unique_ptr<ZeroWatch> watch() const;

 private:
  void receive(const msg::CoilCurrents& message, const MessageSender& sender);
  void beat();
  void tell(const CoilDriver::Beat& beat);
  std::string tryToStop();
  bool endedWell() const;
  void publish(const Eigen::VectorXd& currents, const ros::Time& stamp);
  void diagnoseOutput(DiagnosticStatus& status);

  const bool is_unattended_;  ///< the amplifier has no watchdog of its own, which was accepted
  const double rate_;         ///< of the control loop [Hz]
  std::shared_ptr<DrivenAmplifier> amplifier_;
  CoilDriver& driver_;
  bool stopped_ = false;
  bool is_leaving_ = false;          ///< of the control loop alone
  std::atomic<bool> failed_{false};  ///< the control loop, by an exception
  std::mutex mutex_;                 ///< of what follows, down to told_clamped_
  std::string zero_reason_;
  bool fault_ = false;
  Eigen::VectorXd setpoints_;
  std::size_t clamped_ = 0;       ///< commands so far
  std::size_t told_clamped_ = 0;  ///< of these when diagnostics last looked

  ros::Publisher publisher_;
  ros::Publisher setpoints_publisher_;
  StreamMonitor commands_;
  StreamMonitor currents_;
  TimingDiagnostics timing_;
  LinkDiagnostics link_diagnostics_;
  NodeDiagnostics diagnostics_;
  /// Of the commands alone: they are judged as they come, whatever else the node is busy with. A
  /// flood may still keep roscpp, which reads all links in one thread, from those of the owner:
  /// then the coils have no current.
  ros::CallbackQueue queue_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner receiver_;
  std::unique_ptr<PeriodicThread> thread_;  ///< last, so that it ends first
};

}  // namespace sac
