#include "spherical_actuator_calibration/ros/recording/session_recorder.hpp"

#include <cstdint>
#include <exception>
#include <filesystem>
#include <system_error>

#include <topic_tools/shape_shifter.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

namespace fs = std::filesystem;

/// Seconds at the highest rates.
constexpr std::uint32_t kQueueLength = 20000;

std::string activePath(const std::string& path) {
  return path + ".active";
}

}  // namespace

SessionRecorder::SessionRecorder(const ros::NodeHandle& node,
                                 const std::vector<std::string>& topics,
                                 const std::string& path)
    : path_(path), node_(node), receiver_(1, &queue_) {
  if (fs::exists(path_) || fs::exists(activePath(path_))) {
    throw DataError(path_ + ": the file exists already.");
  }
  try {
    bag_.setCompression(rosbag::compression::LZ4);
    bag_.open(activePath(path_), rosbag::bagmode::Write);
  } catch (const std::exception& error) {
    throw DataError(path_ + ": cannot be written: " + error.what() + ".");
  }
  node_.setCallbackQueue(&queue_);
  for (const std::string& topic : topics) {
    const std::string name = node_.resolveName(topic);
    using Message = topic_tools::ShapeShifter;
    const boost::function<void(const ros::MessageEvent<Message const>&)> receive =
        [this, name](const ros::MessageEvent<Message const>& event) { write(name, event); };
    subscribers_.push_back(node_.subscribe<Message>(
        name, kQueueLength, receive, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }
  receiver_.start();
}

SessionRecorder::~SessionRecorder() {
  receiver_.stop();
  for (ros::Subscriber& subscriber : subscribers_) {
    subscriber.shutdown();
  }
  // What waits has been received: it belongs to the recording.
  queue_.callAvailable();
  try {
    bag_.close();
  } catch (const std::exception&) {
    return;  // it stays as it is, with the ending of an unfinished one
  }
  std::error_code error;
  fs::rename(activePath(path_), path_, error);
}

std::string SessionRecorder::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

template <typename Event>
void SessionRecorder::write(const std::string& topic, const Event& event) {
  try {
    bag_.write(topic, event.getReceiptTime(), *event.getMessage(), event.getConnectionHeaderPtr());
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = path_ + ": " + error.what();
  }
}

}  // namespace sac
