#include "spherical_actuator_calibration/ros/conversion/transform_lookup.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include "spherical_actuator_calibration/base/error.hpp"
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
    for (const geometry_msgs::TransformStamped& transform : message->transforms) {
      buffer_.setTransform(transform, topic, is_static);
    }
  };
  return subscribeChecked<tf2_msgs::TFMessage>(
      node, topic, kQueueLength, receive, tellRefusal(topic));
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
