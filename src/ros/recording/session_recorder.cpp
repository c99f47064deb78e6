#include "spherical_actuator_calibration/ros/recording/session_recorder.hpp"

#include <cstdint>

#include <ros/message_event.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"

namespace sac {
namespace {

/// Seconds at the highest rates. It is emptied as quickly as messages can be copied.
constexpr std::uint32_t kQueueLength = 20000;

}  // namespace

SessionRecorder::SessionRecorder(const ros::NodeHandle& node,
                                 const std::vector<std::string>& topics,
                                 const std::string& path)
    : writer_(path), node_(node), receiver_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  for (const std::string& topic : topics) {
    const std::string name = node_.resolveName(topic);
    using Event = ros::MessageEvent<const RecordedMessage>;
    const boost::function<void(const Event&)> receive = [this, name](const Event& event) {
      const std::string refusal = writer_.add(
          name, {event.getReceiptTime(), event.getConstMessage(), event.getConnectionHeaderPtr()});
      if (!refusal.empty()) {
        tellRefusal(name)(refusal);
      }
    };
    subscribers_.push_back(node_.subscribe<RecordedMessage, const Event&>(
        name, kQueueLength, receive, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }
  receiver_.start();
}

SessionRecorder::~SessionRecorder() {
  try {
    finish();
  } catch (const Error&) {
    // Told by failure().
    return;
  }
}

void SessionRecorder::finish() {
  receiver_.stop();
  for (ros::Subscriber& subscriber : subscribers_) {
    subscriber.shutdown();
  }
  // What waits has been received: it belongs to the recording.
  queue_.callAvailable();
  writer_.finish();
}

}  // namespace sac
