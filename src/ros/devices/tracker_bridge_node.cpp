#include "spherical_actuator_calibration/ros/devices/tracker_bridge_node.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <ros/console.h>
#include <ros/transport_hints.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_streams.hpp"

namespace sac {
namespace {

/// Messages that may wait while the computer is busy: seconds at the highest rates.
constexpr std::uint32_t kTrackerQueueLength = 20000;
constexpr double kTrackerWarningPeriod = 5.0;  // [s]

/// The frame to look up: as configured, or the message's own.
std::string frameOf(const std::string& frame_id, const std::string& configured) {
  if (frame_id.empty()) {
    throw DataError("its header names no frame: set one in the driver");
  }
  if (configured.empty()) {
    // tf2 takes no leading slash; old drivers send one.
    return frame_id[0] == '/' ? frame_id.substr(1) : frame_id;
  }
  if (!isFrame(frame_id, configured)) {
    throw DataError("it " + otherFrame(frame_id, configured));
  }
  return configured;
}

MarkerPoseMeasurement poseFromRos(const geometry_msgs::PoseStamped& message) {
  const geometry_msgs::Point& position = message.pose.position;
  return {stampFromRos(message.header.stamp),
          {position.x, position.y, position.z},
          quaternionFromRos(message.pose.orientation)};
}

WrenchMeasurement wrenchFromRos(const geometry_msgs::WrenchStamped& message) {
  return {stampFromRos(message.header.stamp),
          vectorFromRos(message.wrench.force),
          vectorFromRos(message.wrench.torque)};
}

}  // namespace

TrackerBridgeNode::TrackerBridgeNode(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node,
                                     const Actuator& actuator,
                                     const TrackerBridgeOptions& options)
    : options_(options),
      needs_torque_(actuator.hasTorqueModel()),
      mount_frame_(options.bridge.sensor_mount == SensorMount::kRotor ? options.frames.rotor
                                                                      : options.frames.stator),
      bridge_(options.bridge),
      transforms_(options.transform_wait),
      poses_("tracker/pose", options.tracker_limits),
      wrenches_("ft_sensor/wrench", options.ft_sensor_limits),
      tracker_frame_(options.frames.tracker),
      ft_sensor_frame_(options.frames.ft_sensor),
      diagnostics_(node, private_node, actuator),
      node_(node),
      receiver_(1, &queue_) {
  orientation_publisher_ = node_.advertise<geometry_msgs::QuaternionStamped>("measured_orientation",
                                                                             kTrackerQueueLength);
  torque_publisher_ =
      node_.advertise<geometry_msgs::Vector3Stamped>("measured_torque", kTrackerQueueLength);
  addDiagnostics();
  subscribe();
  receiver_.start();
}

TrackerBridgeNode::~TrackerBridgeNode() {
  receiver_.stop();
}

void TrackerBridgeNode::subscribe() {
  node_.setCallbackQueue(&queue_);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(subscribeChecked<geometry_msgs::PoseStamped>(
      node_,
      "tracker/pose",
      kTrackerQueueLength,
      [this](const geometry_msgs::PoseStamped::ConstPtr& message) { receive(message); },
      [this](const std::string& reason) { poses_.refuse(reason); },
      hints));
  subscribers_.push_back(subscribeChecked<geometry_msgs::WrenchStamped>(
      node_,
      "ft_sensor/wrench",
      kTrackerQueueLength,
      [this](const geometry_msgs::WrenchStamped::ConstPtr& message) { receive(message); },
      [this](const std::string& reason) { refuseWrench(reason); },
      hints));
}

void TrackerBridgeNode::addDiagnostics() {
  diagnostics_.add(poses_);
  if (needs_torque_) {
    diagnostics_.add(wrenches_);
  }
  diagnostics_.add("registrations",
                   [this](DiagnosticStatus& status) { diagnoseRegistrations(status); });
}

void TrackerBridgeNode::receive(const geometry_msgs::PoseStamped::ConstPtr& message) {
  try {
    publishOrientation(*message);
    poses_.accept(message->header.stamp);
  } catch (const Error& error) {
    poses_.refuse(error.what());
    ROS_WARN_STREAM_THROTTLE(kTrackerWarningPeriod,
                             "A tracker pose is refused: " << printable(error.what()) << ".");
  }
  publishTorques();
  tellClockResets();
}

void TrackerBridgeNode::receive(const geometry_msgs::WrenchStamped::ConstPtr& message) {
  try {
    add(*message);
  } catch (const Error& error) {
    refuseWrench(error.what());
  }
  publishTorques();
  tellClockResets();
}

void TrackerBridgeNode::publishOrientation(const geometry_msgs::PoseStamped& message) {
  const std::string frame = frameOf(message.header.frame_id, options_.frames.tracker);
  {
    const std::lock_guard<std::mutex> lock(frames_mutex_);
    tracker_frame_ = frame;
  }
  const BridgeFrames& frames = options_.frames;
  const ros::Time& stamp = message.header.stamp;
  const OrientationMeasurement orientation =
      bridge_.orientation(poseFromRos(message),
                          transforms_.at(frames.stator, frame, stamp),
                          transforms_.at(frames.rotor, frames.marker, stamp));
  geometry_msgs::QuaternionStamped result;
  result.header.stamp = stamp;
  result.header.frame_id = frames.stator;
  result.quaternion = quaternionToRos(orientation.q_stator_rotor);
  orientation_publisher_.publish(result);
}

void TrackerBridgeNode::add(const geometry_msgs::WrenchStamped& message) {
  const std::string frame = frameOf(message.header.frame_id, options_.frames.ft_sensor);
  {
    const std::lock_guard<std::mutex> lock(frames_mutex_);
    ft_sensor_frame_ = frame;
  }
  bridge_.add(wrenchFromRos(message), transforms_.at(mount_frame_, frame, message.header.stamp));
}

void TrackerBridgeNode::publishTorques() {
  const MeasurementBridge::Torques torques = bridge_.takeTorques();
  geometry_msgs::Vector3Stamped message;
  message.header.frame_id = options_.frames.rotor;
  for (const TorqueMeasurement& torque : torques.measurements) {
    message.header.stamp = stampToRos(torque.stamp);
    message.vector = vectorToRos(torque.torque);
    torque_publisher_.publish(message);
    wrenches_.accept(message.header.stamp);
  }
  for (const std::string& reason : torques.refusals) {
    refuseWrench(reason);
  }
}

void TrackerBridgeNode::refuseWrench(const std::string& reason) {
  wrenches_.refuse(reason);
  ROS_WARN_STREAM_THROTTLE(kTrackerWarningPeriod,
                           "A wrench is refused: " << printable(reason) << ".");
}

void TrackerBridgeNode::tellClockResets() {
  if (bridge_.clockResets() != clock_resets_told_) {
    clock_resets_told_ = bridge_.clockResets();
    ROS_INFO("The stamps of the measurements stepped back: the clock was reset.");
  }
}

std::vector<TrackerBridgeNode::Registered> TrackerBridgeNode::registrations() const {
  const BridgeFrames& frames = options_.frames;
  std::vector<Registered> all = {{frames.stator, tracker_frame_}, {frames.rotor, frames.marker}};
  if (needs_torque_) {
    all.push_back({mount_frame_, ft_sensor_frame_});
  }
  return all;
}

void TrackerBridgeNode::diagnoseRegistrations(DiagnosticStatus& status) {
  const std::lock_guard<std::mutex> lock(frames_mutex_);
  status.summary(DiagnosticStatus::OK, "all registrations are known");
  for (const Registered& each : registrations()) {
    if (each.child.empty()) {
      status.mergeSummary(DiagnosticStatus::WARN, "no message has named its frame yet");
      continue;
    }
    const bool known = transforms_.has(each.parent, each.child);
    if (!known) {
      status.mergeSummary(DiagnosticStatus::ERROR, missingTransform(each.parent, each.child));
    }
    status.add(each.parent + " to " + each.child, known ? "known" : "missing");
  }
}

}  // namespace sac
