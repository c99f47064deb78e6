#include "spherical_actuator_calibration/ros/emulation_node/session_bag_writer.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/bag.h>
#include <rosbag/exceptions.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include "spherical_actuator_calibration/CoilCurrents.h"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/conversion/topic_names.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

// From acquisition to recording [ns]: bus, driver and transport of a usual laboratory.
constexpr Stamp kJointLatency = 1'000'000;
constexpr Stamp kTrackerLatency = 8'000'000;
constexpr Stamp kWrenchLatency = 800'000;
constexpr Stamp kCurrentLatency = 1'500'000;
/// What the bridge takes to derive measured_* from a raw message [ns].
constexpr Stamp kBridgeLatency = 300'000;

geometry_msgs::TransformStamped transformMessage(const std::string& parent,
                                                 const std::string& child,
                                                 const Eigen::Isometry3d& X_parent_child,
                                                 const ros::Time& stamp) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform.translation = vectorToRos(X_parent_child.translation());
  message.transform.rotation = quaternionToRos(Eigen::Quaterniond(X_parent_child.linear()));
  return message;
}

}  // namespace

class SessionBagWriter::Recording {
 public:
  Recording(const std::string& path,
            const CalibratedDescription& nominal,
            const SessionBagOptions& options)
      : path_(path),
        active_path_(path + ".active"),
        options_(options),
        bag_(std::make_unique<rosbag::Bag>()),
        has_joints_(nominal.actuator.has_joints) {
    requireFree();
    nameTopics(nominal.actuator);
    guarded([&] {
      bag_->setCompression(options.compression == BagCompression::kLz4
                               ? rosbag::compression::LZ4
                               : rosbag::compression::Uncompressed);
      bag_->open(active_path_, rosbag::bagmode::Write);
    });
    writeTransforms(nominal.actuator);
    writeSetup(nominal);
  }

  ~Recording() { abandon(); }

  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  void add(const JointMeasurement& measurement) {
    if (!has_joints_) {
      return;
    }
    auto& message = joint_states_.message;
    std::copy_n(measurement.position.data(), kJoints, message.position.begin());
    write(joint_states_, measurement.stamp, kJointLatency);
  }

  void add(const MarkerPoseMeasurement& measurement) {
    geometry_msgs::Pose& pose = tracker_pose_.message.pose;
    pose.position = pointToRos(measurement.position);
    pose.orientation = quaternionToRos(measurement.q_tracker_marker);
    write(tracker_pose_, measurement.stamp, kTrackerLatency);
    orientation_.message.quaternion = quaternionToRos(
        orientationFromMarkerPose(options_.registration, measurement).q_stator_rotor);
    write(orientation_, measurement.stamp, kTrackerLatency + kBridgeLatency);
  }

  void add(const WrenchMeasurement& measurement) {
    wrench_.message.wrench.force = vectorToRos(measurement.force);
    wrench_.message.wrench.torque = vectorToRos(measurement.torque);
    write(wrench_, measurement.stamp, kWrenchLatency);
    torque_.message.vector =
        vectorToRos(torqueFromWrench(options_.registration, measurement).torque);
    write(torque_, measurement.stamp, kWrenchLatency + kBridgeLatency);
  }

  void add(const CurrentMeasurement& measurement) {
    const Eigen::VectorXd& current = measurement.current;
    currents_.message.current.assign(current.data(), current.data() + current.size());
    write(currents_, measurement.stamp, kCurrentLatency);
  }

  void close() {
    guarded([this] { bag_->close(); });
    std::error_code error;
    fs::rename(active_path_, path_, error);
    if (error) {
      failToWrite(error.message());
    }
    bag_.reset();
  }

  std::uint64_t messages() const { return messages_; }

 private:
  /// A topic with its message at hand, so that only what changes is filled in anew.
  template <typename Message>
  struct Topic {
    std::string name;
    Message message = {};
  };

  /// Leaves nothing behind, unless the bag is complete.
  void abandon() {
    if (!bag_) {
      return;
    }
    try {
      bag_->close();
    } catch (const rosbag::BagException&) {
      // A bag that cannot be closed throws in its destructor too, which would end the program.
      [[maybe_unused]] const rosbag::Bag* const leaked = bag_.release();
    }
    bag_.reset();
    std::error_code ignored;
    fs::remove(active_path_, ignored);
  }

  [[noreturn]] void failToWrite(const std::string& reason) const {
    throw DataError(path_ + ": cannot be written: " + reason + ".");
  }

  void nameTopics(const Actuator& nominal) {
    const std::string prefix = topicPrefix(options_.ns);
    const FrameNames& frames = options_.frames;
    joint_states_.name = prefix + "joint_states";
    for (const JointAxis& joint : nominal.joints) {
      joint_states_.message.name.push_back(joint.name);
    }
    joint_states_.message.position.resize(kJoints);
    currents_.name = prefix + "coil_currents";
    tracker_pose_.name = prefix + "tracker/pose";
    tracker_pose_.message.header.frame_id = frames.tracker;
    wrench_.name = prefix + "ft_sensor/wrench";
    wrench_.message.header.frame_id = frames.ft_sensor;
    orientation_.name = prefix + "measured_orientation";
    orientation_.message.header.frame_id = frames.stator;
    torque_.name = prefix + "measured_torque";
    torque_.message.header.frame_id = frames.rotor;
  }

  void requireFree() const {
    const bool exists = fs::exists(path_);
    if (exists && !fs::is_regular_file(path_)) {
      throw DataError(path_ + ": is not a regular file; choose another name.");
    }
    if (exists && options_.overwrite == OverwritePolicy::kRefuse) {
      throw DataError(path_ + ": the file exists already; remove it or choose another name.");
    }
  }

  void writeTransforms(const Actuator& nominal) {
    const ros::Time begin = stampToRos(options_.begin);
    const FrameNames& frames = options_.frames;
    const Registration& registration = options_.registration;
    Topic<tf2_msgs::TFMessage> transforms{"/tf_static"};
    transforms.message.transforms = {
        transformMessage(frames.stator, frames.tracker, registration.X_stator_tracker, begin),
        transformMessage(frames.rotor, frames.marker, registration.X_rotor_marker, begin)};
    if (nominal.hasTorqueModel()) {
      transforms.message.transforms.push_back(
          transformMessage(frames.rotor, frames.ft_sensor, registration.X_rotor_sensor, begin));
    }
    writeLatched(transforms, begin);
  }

  /// What the nodes tell of the actuator from the start.
  void writeSetup(const CalibratedDescription& nominal) {
    const ros::Time begin = stampToRos(options_.begin);
    Topic<std_msgs::String> description{topicPrefix(options_.ns) + kDescriptionTopic};
    description.message.data = renderDescription(nominal, description.name);
    writeLatched(description, begin);

    Topic<msg::ActuatorParameters> parameters{topicPrefix(options_.ns) + "parameters"};
    parameters.message = parametersToRos(nominal.actuator);
    parameters.message.source = msg::ActuatorParameters::NOMINAL;
    parameters.message.header.stamp = begin;
    parameters.message.header.frame_id = options_.frames.stator;
    writeLatched(parameters, begin);
  }

  template <typename Message>
  void writeLatched(const Topic<Message>& topic, const ros::Time& time) {
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["topic"] = topic.name;
    (*header)["type"] = ros::message_traits::datatype<Message>();
    (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
    (*header)["message_definition"] = ros::message_traits::definition<Message>();
    (*header)["callerid"] = "/simulate_recording";
    (*header)["latching"] = "1";
    guarded([&] { bag_->write(topic.name, time, topic.message, header); });
    ++messages_;
  }

  template <typename Message>
  void write(Topic<Message>& topic, Stamp stamp, Stamp latency) {
    topic.message.header.stamp = stampToRos(stamp);
    ++topic.message.header.seq;
    guarded([&] { bag_->write(topic.name, stampToRos(stamp + latency), topic.message); });
    ++messages_;
  }

  /// Runs what works on the bag. When it fails, nothing remains.
  template <typename Action>
  void guarded(const Action& action) {
    try {
      action();
    } catch (const rosbag::BagException& error) {
      abandon();
      failToWrite(error.what());
    }
  }

  std::string path_;
  std::string active_path_;
  SessionBagOptions options_;
  std::unique_ptr<rosbag::Bag> bag_;  ///< none after close()
  const bool has_joints_;             ///< else there are no joint_states
  Topic<sensor_msgs::JointState> joint_states_;
  Topic<msg::CoilCurrents> currents_;
  Topic<geometry_msgs::PoseStamped> tracker_pose_;
  Topic<geometry_msgs::WrenchStamped> wrench_;
  Topic<geometry_msgs::QuaternionStamped> orientation_;
  Topic<geometry_msgs::Vector3Stamped> torque_;
  std::uint64_t messages_ = 0;
};

SessionBagWriter::SessionBagWriter(const std::string& path,
                                   const CalibratedDescription& nominal,
                                   const SessionBagOptions& options)
    : recording_(std::make_unique<Recording>(path, nominal, options)) {}

SessionBagWriter::~SessionBagWriter() = default;

void SessionBagWriter::add(const JointMeasurement& measurement) {
  recording_->add(measurement);
}

void SessionBagWriter::add(const MarkerPoseMeasurement& measurement) {
  recording_->add(measurement);
}

void SessionBagWriter::add(const WrenchMeasurement& measurement) {
  recording_->add(measurement);
}

void SessionBagWriter::add(const CurrentMeasurement& measurement) {
  recording_->add(measurement);
}

void SessionBagWriter::close() {
  recording_->close();
}

std::uint64_t SessionBagWriter::messages() const {
  return recording_->messages();
}

}  // namespace sac
