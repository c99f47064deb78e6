#include "spherical_actuator_calibration/ros/conversion/transform_lookup.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"

namespace sac {
namespace {

Eigen::Isometry3d transformFromRos(const geometry_msgs::Transform& message) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = quaternionFromRos(message.rotation).normalized().toRotationMatrix();
  X.translation() = vectorFromRos(message.translation);
  return X;
}

}  // namespace

// Not tf2_ros::TransformListener: it believes every length in a message.
TransformLookup::TransformLookup(double wait) : wait_(wait), receiver_(1, &queue_) {
  buffer_.setUsingDedicatedThread(true);
  ros::NodeHandle node;
  node.setCallbackQueue(&queue_);
  subscribers_ = {listen(node, "/tf", false), listen(node, "/tf_static", true)};
  receiver_.start();
}

TransformLookup::~TransformLookup() {
  receiver_.stop();
}

ros::Subscriber TransformLookup::listen(const ros::NodeHandle& node,
                                        const std::string& topic,
                                        bool is_static) {
  constexpr std::uint32_t kQueueLength = 100;
  const auto receive = [this, topic, is_static](const tf2_msgs::TFMessage::ConstPtr& message) {
    forgetWhenTheClockWentBack();
    bool are_nameable = true;
    for (const geometry_msgs::TransformStamped& transform : message->transforms) {
      if (isNameable(transform.header.frame_id) && isNameable(transform.child_frame_id)) {
        buffer_.setTransform(transform, topic, is_static);
      } else {
        are_nameable = false;
      }
    }
    if (!are_nameable) {
      throw DataError("its frames have names that cannot be shown, or are too many.");
    }
  };
  return subscribeChecked<tf2_msgs::TFMessage>(
      node, topic, kQueueLength, receive, tellRefusal(topic));
}

// tf2 prints names as they are, and keeps every one for ever.
bool TransformLookup::isNameable(const std::string& frame) {
  constexpr std::size_t kLongestName = 200;
  constexpr std::size_t kMostFrames = 2000;
  if (frames_.count(frame) > 0) {
    return true;
  }
  const bool is_good =
      frames_.size() < kMostFrames && frame.size() <= kLongestName && printable(frame) == frame;
  if (is_good) {
    frames_.insert(frame);
  }
  return is_good;
}

void TransformLookup::forgetWhenTheClockWentBack() {
  const ros::Time now = ros::Time::now();
  if (now < newest_) {
    buffer_.clear();
  }
  newest_ = now;
}

Eigen::Isometry3d TransformLookup::at(const std::string& parent,
                                      const std::string& child,
                                      const ros::Time& time) {
  wait(parent, child, time);
  try {
    return transformFromRos(buffer_.lookupTransform(parent, child, time).transform);
  } catch (const tf2::TransformException& error) {
    if (!has(parent, child)) {
      throw DataError(missingTransform(parent, child));
    }
    throw DataError("the transform from \"" + parent + "\" to \"" + child +
                    "\" is not known at the stamp of the measurement: " + error.what());
  }
}

bool TransformLookup::has(const std::string& parent, const std::string& child) const {
  return buffer_.canTransform(parent, child, ros::Time());
}

// tf2's own wait counts by the ROS clock, which may stand still.
void TransformLookup::wait(const std::string& parent,
                           const std::string& child,
                           const ros::Time& time) {
  const auto is_there = [&] { return buffer_.canTransform(parent, child, time); };
  const ros::WallTime begin = ros::WallTime::now();
  if (is_there() || begin < impatient_until_) {
    return;
  }
  const ros::WallDuration pause(0.001);
  while (ros::WallTime::now() < begin + wait_) {
    pause.sleep();
    if (is_there()) {
      return;
    }
  }
  const ros::WallDuration impatience(1.0);
  impatient_until_ = ros::WallTime::now() + impatience;
}

std::string missingTransform(const std::string& parent, const std::string& child) {
  return "there is no transform from \"" + parent + "\" to \"" + child +
         "\": publish the registration, by \"rosrun tf2_ros static_transform_publisher x y z qx qy "
         "qz qw " +
         parent + " " + child + "\" or an argument of lab.launch";
}

}  // namespace sac
