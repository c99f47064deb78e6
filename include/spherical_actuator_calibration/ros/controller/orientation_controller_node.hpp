#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <geometry_msgs/QuaternionStamped.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "spherical_actuator_calibration/CoilCurrents.h"
#include "spherical_actuator_calibration/FollowMotion.h"
#include "spherical_actuator_calibration/MotionStatus.h"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "spherical_actuator_calibration/ros/controller/orientation_controller_options.hpp"
#include "spherical_actuator_calibration/ros/conversion/measurement_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/loop_timing.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

namespace sac {

/// Turns the rotor to the orientations of the topic `orientation_target`, or to where the joint
/// sensors would read the angles of `joint_target`: `joint_states` and the latched `parameters` in,
/// `coil_command` out. Without joints `measured_orientation` takes the place of `joint_states`, and
/// there is no `joint_target`. No command goes out before the private service
/// `enable` is called with true, nor after a safe stop (OrientationController tells when) until it
/// is called again; the coil driver's watchdog guards against the death of this node.
///
/// Every reading that arrives makes one command, in a thread that serves nothing else but
/// `coil_currents`, which tell a stop by the coil driver from one by the rotor. Where none comes
/// for the largest age that is allowed, by a clock that nobody can stop, it stops.
///
/// Enabled, it follows a motion plan instead: the private service `follow_motion` begins it,
/// `end_motion` slows it down to its end before its time, and the private topic `motion_status`
/// tells how far it is. At the end of a motion it is not enabled any more. The private topic
/// `parameters_in_force`, latched, has the message of `parameters` that it controls by.
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
  void advertise(ros::NodeHandle& handle, ros::NodeHandle& private_handle);
  /// To all but the readings, after what is told of them is advertised.
  void subscribe(ros::NodeHandle& handle);
  void receiveParameters(const msg::ActuatorParameters& message);
  /// Says which parameters are in force, once they are.
  void tellParameters();
  template <typename Message>
  void followReadings(ros::NodeHandle& handle, const std::string& topic);
  template <typename Message>
  void receive(const Message& message, const std::string& topic);
  void followCurrents(ros::NodeHandle& handle);
  void receiveTarget(const geometry_msgs::QuaternionStamped& message);
  void receiveJointTarget(const sensor_msgs::JointState& message);
  /// Of the topic that it came by. Precondition: mutex_ is held.
  void refuseTarget(const std::string& topic, const Error& reason);
  bool enable(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool followMotion(msg::FollowMotion::Request& request, msg::FollowMotion::Response& response);
  bool endMotion(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void tellMotion();
  /// One cycle of control on the reading that has come. Precondition: mutex_ is held.
  void command(double reading_interval);
  /// Whether readings still come.
  void watch();
  /// The end of control is a command as well: zero, once. Precondition: mutex_ is held.
  void commandEnd();
  void publish(const Eigen::VectorXd& currents);
  /// The thread of the control must not end the program with currents on. Precondition: mutex_ is
  /// held.
  void fail(const std::string& reason);
  void diagnose(DiagnosticStatus& status);
  /// Precondition: mutex_ is held.
  void diagnoseTiming(DiagnosticStatus& status);

  const Actuator design_;
  const OrientationControllerNodeOptions options_;
  MeasurementReader reader_;  ///< of the thread of the readings

  std::mutex mutex_;  ///< of all below, up to the publisher
  JointStateReader target_reader_;
  msg::CoilCurrents message_;
  OrientationController controller_;
  LoopTiming timing_;
  std::string last_refusal_;
  bool was_active_ = false;
  MotionPhase told_phase_ = MotionPhase::kNone;
  std::optional<msg::ActuatorParameters> parameters_to_tell_;
  Stamp last_stamp_ = 0;       ///< of the newest reading; 0: none
  double last_reading_ = 0.0;  ///< when it came, by a clock that never jumps [s]
  double last_command_ = 0.0;  ///< likewise [s]

  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher motion_publisher_;
  ros::Publisher parameters_publisher_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer motion_timer_;
  NodeDiagnostics diagnostics_;
  ros::CallbackQueue reading_queue_;  ///< of readings and currents: they wait for no service
  ros::Subscriber reading_subscriber_;
  ros::Subscriber current_subscriber_;
  // Last, so that they end first.
  ros::AsyncSpinner control_;
  std::unique_ptr<PeriodicThread> watch_;
};

}  // namespace sac
