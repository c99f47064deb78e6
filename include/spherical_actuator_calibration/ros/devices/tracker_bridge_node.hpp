#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/ros/conversion/transform_lookup.hpp"
#include "spherical_actuator_calibration/ros/devices/tracker_bridge_options.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"
#include "spherical_actuator_calibration/streams/measurement_bridge.hpp"

namespace sac {

/// Derives `measured_orientation` from `tracker/pose` and `measured_torque` from
/// `ft_sensor/wrench`, with their stamps, by the registrations that tf2 knows at those stamps. What
/// is refused is told with its reason on /diagnostics and, now and then, as a warning.
///
/// Measurements are received in a thread of their own. Without wrenches an actuator with a torque
/// model is in error, one without is not.
class TrackerBridgeNode {
 public:
  TrackerBridgeNode(const ros::NodeHandle& node,
                    const ros::NodeHandle& private_node,
                    const Actuator& actuator,
                    const TrackerBridgeOptions& options);
  ~TrackerBridgeNode();
  TrackerBridgeNode(const TrackerBridgeNode&) = delete;
  TrackerBridgeNode& operator=(const TrackerBridgeNode&) = delete;

 private:
  struct Registered {
    std::string parent;
    std::string child;
  };

  void subscribe();
  void addDiagnostics();
  void receive(const geometry_msgs::PoseStamped::ConstPtr& message);
  void receive(const geometry_msgs::WrenchStamped::ConstPtr& message);
  void publishOrientation(const geometry_msgs::PoseStamped& message);
  void add(const geometry_msgs::WrenchStamped& message);
  void publishTorques();
  void refuseWrench(const std::string& reason);
  void tellClockResets();
  std::vector<Registered> registrations() const;
  void diagnoseRegistrations(DiagnosticStatus& status);

  const TrackerBridgeOptions options_;
  const bool needs_torque_;
  const std::string mount_frame_;  ///< of the body that carries the force/torque sensor

  // Used by the receiving thread alone, or thread-safe by themselves.
  MeasurementBridge bridge_;
  std::uint64_t clock_resets_told_ = 0;
  TransformLookup transforms_;
  StreamMonitor poses_;
  StreamMonitor wrenches_;
  ros::Publisher orientation_publisher_;
  ros::Publisher torque_publisher_;

  std::mutex frames_mutex_;      ///< of the two frames
  std::string tracker_frame_;    ///< of the newest pose, or as configured
  std::string ft_sensor_frame_;  ///< of the newest wrench, or as configured

  NodeDiagnostics diagnostics_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;  ///< its callbacks run in the receiving thread
  std::vector<ros::Subscriber> subscribers_;
  ros::AsyncSpinner receiver_;
};

}  // namespace sac
