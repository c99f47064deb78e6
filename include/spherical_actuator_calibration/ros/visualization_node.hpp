#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/transform_broadcaster.h>

#include "spherical_actuator_calibration/CalibrationSample.h"
#include "spherical_actuator_calibration/CoilCurrents.h"
#include "spherical_actuator_calibration/core/actuator.hpp"
#include "spherical_actuator_calibration/ros/calibration_markers.hpp"

namespace spherical_actuator_calibration {

struct VisualizationOptions {
  double error_magnification = 10.0;  ///< of the axes' errors, in the markers
  std::string stator_frame = "stator";
  std::string rotor_frame = "rotor";
  std::string joint_frame_prefix;  ///< of joint_1 and joint_2, the frames between the joints
};

/// Loads the private parameters of the node. Throws ConfigError that names the key.
VisualizationOptions loadVisualizationOptions(const ros::NodeHandle& private_node);

/// Shows a calibration in rviz: the frames joint_1, joint_2 and rotor by the parameters in force
/// and rotor_nominal by the nominal ones on /tf, and the topic `calibration_markers` (latched). See
/// calibration_markers.hpp.
class VisualizationNode {
 public:
  VisualizationNode(const ros::NodeHandle& node,
                    const Actuator& nominal,
                    const VisualizationOptions& options);

 private:
  void receiveJoints(const sensor_msgs::JointState& message);
  void broadcast(const ros::Time& stamp, const Eigen::Vector3d& q);
  void publishMarkers();

  VisualizationOptions options_;
  CalibrationScene scene_;
  std::map<std::uint32_t, Eigen::Vector3d> samples_;  ///< directions by id
  ros::Time last_broadcast_;
  bool changed_ = true;
  ros::NodeHandle node_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace spherical_actuator_calibration
