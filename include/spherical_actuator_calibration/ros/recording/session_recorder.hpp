#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <rosbag/bag.h>

namespace sac {

/// Keeps a bag of topics of any type. Unlike `rosbag record`, whose queues hold 100 messages, it
/// loses none of a fast stream while the computer is busy for seconds: what the calibration node
/// got is in the recording.
///
/// The bag has the ending .bag.active until it is closed, by the destructor.
class SessionRecorder {
 public:
  /// Records what comes from now on, in a thread of its own. Throws DataError, naming the file,
  /// when the bag cannot be written or exists already.
  SessionRecorder(const ros::NodeHandle& node,
                  const std::vector<std::string>& topics,
                  const std::string& path);
  ~SessionRecorder();
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  /// What went wrong: a full disk, say. Empty while nothing has.
  std::string failure() const;

 private:
  template <typename Event>
  void write(const std::string& topic, const Event& event);

  std::string path_;
  rosbag::Bag bag_;
  mutable std::mutex mutex_;  ///< of failure_
  std::string failure_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::AsyncSpinner receiver_;
};

}  // namespace sac
