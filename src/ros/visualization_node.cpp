#include "spherical_actuator_calibration/ros/visualization_node.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include <geometry_msgs/TransformStamped.h>

#include "spherical_actuator_calibration/core/rotations.hpp"
#include "spherical_actuator_calibration/core/spherical_joint.hpp"
#include "spherical_actuator_calibration/core/yaml_reader.hpp"
#include "spherical_actuator_calibration/ros/message_types.hpp"
#include "spherical_actuator_calibration/ros/parameter_text.hpp"

namespace spherical_actuator_calibration {
namespace {

constexpr double kFramePeriod = 0.02;  // [s]
constexpr double kMarkerPeriod = 0.1;  // [s]
constexpr double kLargestMagnification = 1000.0;

/// The nominal actuator with the values of a message; nothing when it is of another design.
bool applyParameters(const ActuatorParameters& message, Actuator& actuator) {
  if (message.poles.size() != actuator.poles.size() ||
      message.coils.size() != actuator.coils.size()) {
    return false;
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    const auto& axis = message.joints[k].axis;
    actuator.joints[k].axis = Eigen::Vector3d(axis.x, axis.y, axis.z);
    actuator.joints[k].offset = message.joints[k].offset;
  }
  for (std::size_t i = 0; i < actuator.poles.size(); ++i) {
    actuator.poles[i].polar = message.poles[i].polar;
    actuator.poles[i].azimuth = message.poles[i].azimuth;
  }
  for (std::size_t j = 0; j < actuator.coils.size(); ++j) {
    actuator.coils[j].polar = message.coils[j].polar;
    actuator.coils[j].azimuth = message.coils[j].azimuth;
  }
  return true;
}

geometry_msgs::TransformStamped rotationTransform(const ros::Time& stamp,
                                                  const std::string& parent,
                                                  const std::string& child,
                                                  const Eigen::Matrix3d& R_parent_child) {
  const Eigen::Quaterniond q(R_parent_child);
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.rotation.x = q.x();
  transform.transform.rotation.y = q.y();
  transform.transform.rotation.z = q.z();
  transform.transform.rotation.w = q.w();
  return transform;
}

}  // namespace

VisualizationOptions loadVisualizationOptions(const ros::NodeHandle& private_node) {
  const YamlMap map =
      YamlMap::parse(privateParameterText(private_node), private_node.getNamespace());
  VisualizationOptions options;
  options.error_magnification = map.number("error_magnification",
                                           ValueRange::closed(1.0, kLargestMagnification),
                                           options.error_magnification);
  options.joint_frame_prefix = map.text("frame_prefix", options.joint_frame_prefix);
  options.stator_frame = options.joint_frame_prefix + options.stator_frame;
  options.rotor_frame = options.joint_frame_prefix + options.rotor_frame;
  map.finish();
  return options;
}

VisualizationNode::VisualizationNode(const ros::NodeHandle& node,
                                     const Actuator& nominal,
                                     const VisualizationOptions& options)
    : options_(options), node_(node) {
  scene_.nominal = nominal;
  scene_.identified = nominal;
  scene_.magnification = options.error_magnification;
  scene_.stator_frame = options.stator_frame;
  scene_.rotor_frame = options.rotor_frame;
  constexpr bool kLatched = true;
  publisher_ = node_.advertise<visualization_msgs::MarkerArray>("calibration_markers", 1, kLatched);
  constexpr std::uint32_t kQueueLength = 1000;
  subscribers_.push_back(
      node_.subscribe("joint_states", kQueueLength, &VisualizationNode::receiveJoints, this));
  subscribers_.push_back(node_.subscribe<ActuatorParameters>(
      "parameters", 1, [this](const ActuatorParameters::ConstPtr& message) {
        changed_ = applyParameters(*message, scene_.identified) || changed_;
      }));
  subscribers_.push_back(node_.subscribe<CoilCurrents>(
      "coil_currents", 1, [this](const CoilCurrents::ConstPtr& message) {
        scene_.currents = Eigen::Map<const Eigen::VectorXd>(
            message->current.data(), static_cast<Eigen::Index>(message->current.size()));
        changed_ = true;
      }));
  subscribers_.push_back(node_.subscribe<CalibrationSample>(
      "samples", kQueueLength, [this](const CalibrationSample::ConstPtr& message) {
        if (message->has_orientation != 0) {
          const auto& q = message->orientation;
          samples_[message->id] =
              Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized() * Eigen::Vector3d::UnitZ();
          changed_ = true;
        }
      }));
  timer_ =
      node_.createWallTimer(ros::WallDuration(kMarkerPeriod),
                            [this](const ros::WallTimerEvent& /*event*/) { publishMarkers(); });
}

void VisualizationNode::receiveJoints(const sensor_msgs::JointState& message) {
  const double age = (message.header.stamp - last_broadcast_).toSec();
  if (message.position.size() != kJoints || (age >= 0.0 && age < kFramePeriod)) {
    return;
  }
  const Eigen::Vector3d q(message.position.data());
  if (q.allFinite()) {
    broadcast(message.header.stamp, q);
    last_broadcast_ = message.header.stamp;
  }
}

void VisualizationNode::broadcast(const ros::Time& stamp, const Eigen::Vector3d& q) {
  const auto& joints = scene_.identified.joints;
  const auto turned = [&](std::size_t k) {
    return rotationExp(joints[k].axis.normalized() *
                       (q[static_cast<Eigen::Index>(k)] + joints[k].offset));
  };
  const std::string joint_1 = options_.joint_frame_prefix + "joint_1";
  const std::string joint_2 = options_.joint_frame_prefix + "joint_2";
  broadcaster_.sendTransform(std::vector<geometry_msgs::TransformStamped>{
      rotationTransform(stamp, options_.stator_frame, joint_1, turned(0)),
      rotationTransform(stamp, joint_1, joint_2, turned(1)),
      rotationTransform(stamp, joint_2, options_.rotor_frame, turned(2)),
      rotationTransform(stamp,
                        options_.stator_frame,
                        options_.rotor_frame + "_nominal",
                        rotorOrientation(jointGeometry(scene_.nominal.joints), q))});
}

void VisualizationNode::publishMarkers() {
  if (!changed_) {
    return;
  }
  changed_ = false;
  scene_.sampled_directions.clear();
  for (const auto& [id, direction] : samples_) {
    scene_.sampled_directions.push_back(direction);
  }
  publisher_.publish(calibrationMarkers(scene_));
}

}  // namespace spherical_actuator_calibration
