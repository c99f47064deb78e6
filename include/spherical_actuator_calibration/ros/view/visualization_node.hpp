#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <geometry_msgs/QuaternionStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/transform_broadcaster.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/actuator_dimensions.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/view/live_scene.hpp"
#include "spherical_actuator_calibration/ros/view/sample_listing.hpp"

namespace sac {

/// Private parameters of the node.
struct VisualizationOptions {
  double error_magnification = 10.0;  ///< of the axes' errors and deviations, in the markers
  std::string frame_prefix;           ///< before the names of all frames
  ActuatorDimensions dimensions;
};

/// Loads the private parameters of the node. Throws ConfigError that names the key.
VisualizationOptions loadVisualizationOptions(const ros::NodeHandle& private_node);

/// Shows a calibration in rviz:
/// - on /tf the frames joint_1, joint_2 and rotor by the parameters in force, and rotor_nominal by
///   the nominal ones; of a rotor without joints rotor and rotor_nominal, both as the tracker
///   measures them;
/// - the latched topic `calibration_markers`, see calibration_markers.hpp;
/// - the private parameter `robot_description`, made from the description of the actuator with the
///   prefix before the names of its links, so that it fits these frames.
class VisualizationNode {
 public:
  VisualizationNode(const ros::NodeHandle& node,
                    const ros::NodeHandle& private_node,
                    const Actuator& nominal,
                    const VisualizationOptions& options);

 private:
  template <typename Message>
  void feed(const std::string& topic, std::uint32_t queue_length);

  void show();
  void receiveJoints(const sensor_msgs::JointState& message);
  void receiveOrientation(const geometry_msgs::QuaternionStamped& message);
  bool isDue(const ros::Time& stamp) const;
  void broadcast(const ros::Time& stamp, const Eigen::Vector3d& q);
  void publishMarkers();

  VisualizationOptions options_;
  SceneFrames frames_;
  Actuator nominal_;
  LiveScene scene_;
  JointStateReader joint_reader_;
  ros::Time last_broadcast_;
  ros::NodeHandle node_;
  SampleListing listing_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace sac
