#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "spherical_actuator_calibration/Push.h"
#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/emulation/emulated_amplifier.hpp"
#include "spherical_actuator_calibration/emulation/emulated_sensors.hpp"
#include "spherical_actuator_calibration/emulation/free_rotor.hpp"
#include "spherical_actuator_calibration/emulation/laboratory_history.hpp"
#include "spherical_actuator_calibration/emulation/modbus_server.hpp"
#include "spherical_actuator_calibration/emulation/positioning_fixture.hpp"
#include "spherical_actuator_calibration/emulation/true_actuator.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/emulation_node/lab_emulator_options.hpp"
#include "spherical_actuator_calibration/ros/node/periodic_thread.hpp"

namespace sac {

/// The laboratory without hardware, at the level of its wires: Modbus TCP devices for joint sensor
/// and coil amplifier, and what the ROS drivers of a tracker and a force/torque sensor publish
/// (`tracker/pose`, `ft_sensor/wrench`), each in its own frame. A fixture holds the rotor and
/// follows `fixture/target`; that of a rotor without joints, where there is no joint sensor either,
/// follows `fixture/orientation_target`. Released by the private service release_fixture, the rotor
/// moves by coils and gravity, and the force/torque sensor, which goes with the fixture, is silent.
/// The private topic `true_orientation` tells what no laboratory knows. The unit in it is made from
/// the description by the seed, as `simulate_recording --seed` makes it.
///
/// Registers are those of the very time of a request, as far as the streams are not late
/// (StreamDelays): laboratories are as exact at 1 kHz as their drivers' threads.
///
/// The private service push turns the released rotor as a hand would, for a while. Others inject
/// faults: lose_tracker, freeze_sensor (the joint sensors' registers stand
/// still; not without joints), inject_outlier (one tracker pose and one wrench far off),
/// trip_amplifier.
class LabEmulatorNode {
 public:
  /// Throws TransportError when a port is taken, DataError when the truth cannot be written.
  LabEmulatorNode(const ros::NodeHandle& node,
                  const ros::NodeHandle& private_node,
                  const Actuator& nominal,
                  const LabEmulatorOptions& options);
  ~LabEmulatorNode();
  LabEmulatorNode(const LabEmulatorNode&) = delete;
  LabEmulatorNode& operator=(const LabEmulatorNode&) = delete;

 private:
  using SetBool = std_srvs::SetBool;
  using Trigger = std_srvs::Trigger;

  void startJointSensor();
  void advertiseFaults();
  void advertiseFault(const char* name, bool& flag, const char* what);
  template <typename Message>
  void followTargets(const std::string& topic);
  Eigen::Vector3d targetOf(const sensor_msgs::JointState& message) const;
  Eigen::Vector3d targetOf(const geometry_msgs::QuaternionStamped& message) const;
  void setTarget(const Eigen::Vector3d& target);
  bool releaseFixture(SetBool::Request& request, SetBool::Response& response);
  bool push(msg::Push::Request& request, msg::Push::Response& response);
  void answerJointSensor();
  void answerAmplifier();
  void beat();
  /// Everything on to a time [s]. Precondition of this and of all below: mutex_ is held.
  void advanceTo(double now);
  void moveRotor(double step);
  /// What the joint sensors would read without their errors, or where there are no joints the
  /// angles that stand for the orientation [rad].
  const Eigen::Vector3d& position() const;
  void showJoints();
  void showCurrents();
  /// When it was what it is now, by the clock of the stamps.
  ros::Time stampOfState() const;
  void publishPose();
  void publishTruth();
  void publishWrench();

  const LabEmulatorOptions options_;
  const Actuator truth_;
  TrueActuator actuator_;
  std::unique_ptr<ModbusServer> joint_server_;  ///< null without joints
  ModbusServer amplifier_server_;

  std::mutex mutex_;  ///< of all below, up to the publishers
  PositioningFixture fixture_;
  std::optional<FreeRotor> free_rotor_;  ///< none without torque model
  bool released_ = false;
  EmulatedAmplifier amplifier_;
  EmulatedJointSensor joints_;
  EmulatedTracker tracker_;
  EmulatedWrenchSensor ft_sensor_;
  EmulatedCurrentSensor current_sensor_;
  bool tracker_lost_ = false;
  bool sensor_frozen_ = false;
  bool amplifier_tripped_ = false;
  bool outlier_pose_ = false;
  bool outlier_wrench_ = false;
  LaboratoryHistory history_;
  double now_ = 0.0;                                       ///< up to which it has come [s]
  double joints_shown_ = 0.0;                              ///< when they were read last [s]
  double pose_due_ = 0.0;                                  ///< [s]
  Eigen::Vector3d push_stator_ = Eigen::Vector3d::Zero();  ///< [N·m]
  double push_end_ = 0.0;                                  ///< [s]
  geometry_msgs::PoseStamped pose_message_;
  geometry_msgs::WrenchStamped wrench_message_;
  geometry_msgs::QuaternionStamped true_message_;

  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  ros::Publisher pose_publisher_;
  ros::Publisher wrench_publisher_;
  ros::Publisher true_publisher_;
  ros::Subscriber target_subscriber_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<PeriodicThread> thread_;
};

}  // namespace sac
