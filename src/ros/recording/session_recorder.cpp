#include "spherical_actuator_calibration/ros/recording/session_recorder.hpp"

#include <cstdint>
#include <typeinfo>
#include <utility>

#include <boost/make_shared.hpp>
#include <ros/subscribe_options.h>
#include <ros/subscription_callback_helper.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"

namespace sac {
namespace {

/// Seconds at the highest rates. It is emptied as quickly as messages can be copied.
constexpr std::uint32_t kQueueLength = 20000;

/// Gives the messages of a topic to a writer as they come. What the writer would leave out is not
/// copied, so that a flood of long messages leaves roscpp's queue as quickly as it gets there.
class MessageCopier final : public ros::SubscriptionCallbackHelper {
 public:
  MessageCopier(std::string topic, RecordingWriter& writer)
      : topic_(std::move(topic)), writer_(writer) {}

  ros::VoidConstPtr deserialize(
      const ros::SubscriptionCallbackHelperDeserializeParams& params) override {
    const auto message = boost::make_shared<RecordedMessage>();
    message->length = params.length;
    if (writer_.refusal(topic_, params.length).empty()) {
      message->bytes.assign(params.buffer, params.buffer + params.length);
    }
    return message;
  }

  void call(ros::SubscriptionCallbackHelperCallParams& params) override {
    const ros::MessageEvent<void const>& event = params.event;
    const std::string refusal =
        writer_.add(topic_,
                    {event.getReceiptTime(),
                     boost::static_pointer_cast<const RecordedMessage>(event.getConstMessage()),
                     event.getConnectionHeaderPtr()});
    if (!refusal.empty()) {
      tellRefusal(topic_)(refusal);
    }
  }

  const std::type_info& getTypeInfo() override { return typeid(RecordedMessage); }
  bool isConst() override { return true; }
  bool hasHeader() override { return false; }

 private:
  std::string topic_;
  RecordingWriter& writer_;
};

ros::SubscribeOptions optionsOf(const std::string& topic, RecordingWriter& writer) {
  ros::SubscribeOptions options;
  options.topic = topic;
  options.queue_size = kQueueLength;
  options.md5sum = "*";
  options.datatype = "*";
  options.helper = boost::make_shared<MessageCopier>(topic, writer);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return options;
}

}  // namespace

SessionRecorder::SessionRecorder(const ros::NodeHandle& node,
                                 const std::vector<std::string>& topics,
                                 const std::string& path)
    : writer_(path), node_(node), receiver_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  for (const std::string& topic : topics) {
    ros::SubscribeOptions options = optionsOf(node_.resolveName(topic), writer_);
    subscribers_.push_back(node_.subscribe(options));
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
