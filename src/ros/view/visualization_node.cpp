#include "spherical_actuator_calibration/ros/view/visualization_node.hpp"

#include <Eigen/Geometry>

#include <geometry_msgs/TransformStamped.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/urdf_generator.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/parameter_map.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"

namespace sac {
namespace {

constexpr double kFramePeriod = 0.02;  // [s]
constexpr double kMarkerPeriod = 0.1;  // [s]
constexpr double kLargestMagnification = 1000.0;

geometry_msgs::TransformStamped rotationTransform(const ros::Time& stamp,
                                                  const std::string& parent,
                                                  const std::string& child,
                                                  const Eigen::Matrix3d& R_parent_child) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.rotation = quaternionToRos(Eigen::Quaterniond(R_parent_child));
  return transform;
}

SceneFrames prefixed(const std::string& prefix) {
  SceneFrames frames;
  frames.stator = prefix + frames.stator;
  frames.rotor = prefix + frames.rotor;
  frames.nominal_rotor = prefix + frames.nominal_rotor;
  frames.joint_1 = prefix + frames.joint_1;
  frames.joint_2 = prefix + frames.joint_2;
  return frames;
}

CalibrationScene startOf(const Actuator& nominal, const VisualizationOptions& options) {
  CalibrationScene scene;
  scene.nominal = nominal;
  scene.dimensions = options.dimensions;
  scene.magnification = options.error_magnification;
  scene.frames = prefixed(options.frame_prefix);
  return scene;
}

}  // namespace

VisualizationOptions loadVisualizationOptions(const ros::NodeHandle& private_node) {
  const YamlMap map = privateParameters(private_node);
  VisualizationOptions options;
  options.error_magnification = map.number("error_magnification",
                                           ValueRange::closed(1.0, kLargestMagnification),
                                           options.error_magnification);
  options.frame_prefix = map.text("frame_prefix", options.frame_prefix);
  options.dimensions = readDimensions(map);
  // Made by an earlier run of this node.
  map.text("robot_description", "");
  map.finish();
  return options;
}

VisualizationNode::VisualizationNode(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node,
                                     const Actuator& nominal,
                                     const VisualizationOptions& options)
    : options_(options),
      frames_(prefixed(options.frame_prefix)),
      nominal_(nominal),
      scene_(startOf(nominal, options)),
      joint_reader_(jointNames(nominal)),
      node_(node),
      listing_(node.resolveName("calibration/list_samples")) {
  private_node.setParam("robot_description",
                        renderUrdf(nominal, options.dimensions, options.frame_prefix));
  constexpr bool kLatched = true;
  publisher_ = node_.advertise<visualization_msgs::MarkerArray>("calibration_markers", 1, kLatched);
  constexpr std::uint32_t kQueueLength = 1000;
  if (nominal.has_joints) {
    subscribers_.push_back(subscribeChecked<sensor_msgs::JointState>(
        node_,
        "joint_states",
        kQueueLength,
        [this](const sensor_msgs::JointState::ConstPtr& message) { receiveJoints(*message); },
        tellRefusal("joint_states")));
  } else {
    subscribers_.push_back(subscribeChecked<geometry_msgs::QuaternionStamped>(
        node_,
        "measured_orientation",
        kQueueLength,
        [this](const geometry_msgs::QuaternionStamped::ConstPtr& message) {
          receiveOrientation(*message);
        },
        tellRefusal("measured_orientation")));
  }
  feed<msg::ActuatorParameters>("parameters", 1);
  feed<msg::CalibrationReport>("report", kQueueLength);
  feed<msg::CalibrationStatus>("status", 1);
  feed<msg::CoilCurrents>("coil_currents", 1);
  feed<msg::CalibrationSample>("samples", kQueueLength);
  feed<sensor_msgs::JointState>("wanted_pose", 1);
  timer_ = node_.createWallTimer(ros::WallDuration(kMarkerPeriod),
                                 [this](const ros::WallTimerEvent& /*event*/) { show(); });
}

template <typename Message>
void VisualizationNode::feed(const std::string& topic, std::uint32_t queue_length) {
  subscribers_.push_back(subscribeChecked<Message>(
      node_,
      topic,
      queue_length,
      [this](const typename Message::ConstPtr& message) { scene_.receive(*message); },
      tellRefusal(topic)));
}

// What cannot be drawn is told and ends nothing.
void VisualizationNode::show() {
  try {
    listing_.update(scene_.samples());
    publishMarkers();
  } catch (const std::exception& error) {
    tellRefusal("calibration_markers")(error.what());
  }
}

bool VisualizationNode::isDue(const ros::Time& stamp) const {
  const double age = secondsBetween(last_broadcast_, stamp);
  return age < 0.0 || age >= kFramePeriod;
}

void VisualizationNode::receiveJoints(const sensor_msgs::JointState& message) {
  if (!isDue(message.header.stamp)) {
    return;
  }
  const std::optional<JointMeasurement> joints = joint_reader_.read(message);
  if (joints && joints->position.allFinite()) {
    broadcast(message.header.stamp, joints->position);
    last_broadcast_ = message.header.stamp;
  }
}

// The tracker measures what is shown: nothing of it is calibrated.
void VisualizationNode::receiveOrientation(const geometry_msgs::QuaternionStamped& message) {
  const OrientationMeasurement orientation = orientationFromRos(message);
  if (!isDue(message.header.stamp) || !isUnit(orientation.q_stator_rotor) ||
      !isFrame(message.header.frame_id, frames_.stator)) {
    return;
  }
  const Eigen::Matrix3d R_stator_rotor = orientation.q_stator_rotor.normalized().toRotationMatrix();
  const ros::Time& stamp = message.header.stamp;
  broadcaster_.sendTransform(std::vector<geometry_msgs::TransformStamped>{
      rotationTransform(stamp, frames_.stator, frames_.rotor, R_stator_rotor),
      rotationTransform(stamp, frames_.stator, frames_.nominal_rotor, R_stator_rotor)});
  last_broadcast_ = stamp;
}

void VisualizationNode::broadcast(const ros::Time& stamp, const Eigen::Vector3d& q) {
  const JointGeometry joints = jointGeometry(scene_.identified());
  const Eigen::Vector3d angles = correctedReading(joints, q) + joints.offsets;
  const Eigen::Matrix3d R_stator_joint_1 = rotationExp(joints.axes.col(0).normalized() * angles[0]);
  const Eigen::Matrix3d R_joint_1_joint_2 =
      rotationExp(joints.axes.col(1).normalized() * angles[1]);
  // The last one takes up what the orientation map adds.
  const Eigen::Matrix3d R_joint_2_rotor =
      (R_stator_joint_1 * R_joint_1_joint_2).transpose() * rotorOrientation(joints, q);
  const std::string joint_1 = options_.frame_prefix + "joint_1";
  const std::string joint_2 = options_.frame_prefix + "joint_2";
  broadcaster_.sendTransform(std::vector<geometry_msgs::TransformStamped>{
      rotationTransform(stamp, frames_.stator, joint_1, R_stator_joint_1),
      rotationTransform(stamp, joint_1, joint_2, R_joint_1_joint_2),
      rotationTransform(stamp, joint_2, frames_.rotor, R_joint_2_rotor),
      rotationTransform(stamp,
                        frames_.stator,
                        frames_.nominal_rotor,
                        rotorOrientation(jointGeometry(nominal_), q))});
}

void VisualizationNode::publishMarkers() {
  if (scene_.takeChange()) {
    publisher_.publish(calibrationMarkers(scene_.scene()));
  }
}

}  // namespace sac
