#pragma once

#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include "spherical_actuator_calibration/ros/recording/recording_writer.hpp"

namespace sac {

/// Keeps a bag of topics of any type. Unlike `rosbag record`, whose queues hold 100 messages, it
/// loses none of a fast stream while the computer is busy for seconds: what the calibration node
/// got is in the recording. Messages that are longer than any reader takes, or more than the disk
/// takes, are left out with a warning.
///
/// The bag has the ending .bag.active until it is closed, by finish() or the destructor.
class SessionRecorder {
 public:
  /// Records what comes from now on, in threads of its own. Throws DataError, naming the file,
  /// when the bag cannot be written or exists already.
  SessionRecorder(const ros::NodeHandle& node,
                  const std::vector<std::string>& topics,
                  const std::string& path);
  ~SessionRecorder();
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  /// What went wrong: a full disk, say. Empty while nothing has.
  std::string failure() const { return writer_.failure(); }

  /// Ends the recording. Throws DataError with failure().
  void finish();

 private:
  RecordingWriter writer_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::AsyncSpinner receiver_;
};

}  // namespace sac
