#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

#include <geometry_msgs/QuaternionStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "spherical_actuator_calibration/CoilCurrents.h"
#include "spherical_actuator_calibration/FollowMotion.h"
#include "spherical_actuator_calibration/MotionStatus.h"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "spherical_actuator_calibration/ros/controller/orientation_controller_options.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

namespace sac {

/// How long the cycles of a control loop take and how steadily they come, since the last report.
class CycleStatistics {
 public:
  /// `period` [s] that the cycles should have.
  explicit CycleStatistics(double period) : period_(period) {}

  /// A cycle that began and ended then, by a clock that never jumps [s].
  void add(double begin, double end);
  /// Writes what was gathered into a diagnostic status, and begins anew. Missed cycles add up.
  void report(DiagnosticStatus& status);
  /// The next cycle does not follow the last one.
  void interrupt() { last_begin_ = 0.0; }

 private:
  double period_;
  double last_begin_ = 0.0;  ///< 0: none
  std::size_t cycles_ = 0;
  std::size_t missed_ = 0;
  double total_ = 0.0;           ///< of computation [s]
  double longest_ = 0.0;         ///< computation [s]
  double largest_jitter_ = 0.0;  ///< deviation of an interval from the period [s]
};

/// Turns the rotor to the orientations of the topic `orientation_target`: `joint_states` and the
/// latched `parameters` in, `coil_command` out. No command goes out before the private service
/// `enable` is called with true, nor after a safe stop (OrientationController tells when) until it
/// is called again; the coil driver's watchdog guards against the death of this node.
///
/// Enabled, it follows a motion plan instead: the private service `follow_motion` begins it,
/// `end_motion` slows it down to its end before its time, and the private topic `motion_status`
/// tells how far it is. At the end of a motion it is not enabled any more.
class OrientationControllerNode {
 public:
  /// Throws ConfigError when the description has no torque model or an option is not valid.
  OrientationControllerNode(const ros::NodeHandle& node,
                            const ros::NodeHandle& private_node,
                            const Actuator& design,
                            const OrientationControllerNodeOptions& options);
  ~OrientationControllerNode();
  OrientationControllerNode(const OrientationControllerNode&) = delete;
  OrientationControllerNode& operator=(const OrientationControllerNode&) = delete;

 private:
  void receiveParameters(const msg::ActuatorParameters& message);
  void receiveJoints(const sensor_msgs::JointState& message);
  void receiveTarget(const geometry_msgs::QuaternionStamped& message);
  bool enable(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool followMotion(msg::FollowMotion::Request& request, msg::FollowMotion::Response& response);
  bool endMotion(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void tellMotion();
  void beat();
  /// One cycle of control. Precondition: mutex_ is held.
  void cycle();
  void publish(const Eigen::VectorXd& currents);
  void diagnose(DiagnosticStatus& status);

  const Actuator design_;
  const OrientationControllerNodeOptions options_;
  JointStateReader joint_reader_;
  msg::CoilCurrents message_;  ///< of the thread of the cycles

  std::mutex mutex_;  ///< of all below, up to the publisher
  OrientationController controller_;
  CycleStatistics statistics_;
  std::string last_refusal_;
  bool was_active_ = false;
  MotionPhase told_phase_ = MotionPhase::kNone;
  double last_reading_ =
      0.0;  ///< when joint angles were last accepted, by a clock that never jumps

  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher motion_publisher_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer motion_timer_;
  NodeDiagnostics diagnostics_;
  std::unique_ptr<PeriodicThread> thread_;  ///< last, so that it ends first
};

}  // namespace sac
