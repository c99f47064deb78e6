#pragma once

#include <array>
#include <set>
#include <string>

#include <Eigen/Geometry>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <ros/time.h>
#include <tf2_ros/buffer.h>

namespace sac {

/// Transforms of tf2 at the stamp of a measurement. Listens from construction on, in a thread of
/// its own.
class TransformLookup {
 public:
  /// `wait`: how long a transform that is not there yet is waited for [s of the wall clock].
  explicit TransformLookup(double wait);
  ~TransformLookup();
  TransformLookup(const TransformLookup&) = delete;
  TransformLookup& operator=(const TransformLookup&) = delete;

  /// X_parent_child at a time. After a wait in vain the next calls do not wait for a while, so that
  /// a missing transform does not hold up everything. Throws DataError that names the transform and
  /// how to publish it.
  Eigen::Isometry3d at(const std::string& parent, const std::string& child, const ros::Time& time);

  /// Whether it is known at any time.
  bool has(const std::string& parent, const std::string& child) const;

 private:
  ros::Subscriber listen(const ros::NodeHandle& node, const std::string& topic, bool is_static);
  void forgetWhenTheClockWentBack();
  bool isNameable(const std::string& frame);
  void wait(const std::string& parent, const std::string& child, const ros::Time& time);

  const ros::WallDuration wait_;
  ros::WallTime impatient_until_;
  tf2_ros::Buffer buffer_;
  ros::CallbackQueue queue_;
  ros::Time newest_;                            ///< of the ROS clock; used by the receiving thread
  std::set<std::string> frames_;                ///< that are known; likewise
  std::array<ros::Subscriber, 2> subscribers_;  ///< of /tf and /tf_static
  ros::AsyncSpinner receiver_;
};

/// "there is no transform from … to …: …" with the command that publishes it.
std::string missingTransform(const std::string& parent, const std::string& child);

}  // namespace sac
