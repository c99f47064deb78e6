#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <type_traits>

#include <boost/function.hpp>
#include <boost/shared_ptr.hpp>
#include <ros/console.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/transport_hints.h>

#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_message.hpp"

namespace sac {

/// Who sent a message.
struct MessageSender {
  std::string name;  ///< of the node, as it says
  /// The same for all messages that came by one connection: tells two of one name apart.
  const void* connection = nullptr;
};

/// Subscribes to messages of other nodes so that none of them can end this one: lengths in them are
/// held against their bytes (CheckedStream), and what `receive` throws is told to `refuse`.
///
/// receive(const boost::shared_ptr<const Message>&) takes a message, with a second argument, a
/// const MessageSender&, also who sent it; refuse(const std::string&) takes the
/// reason why one is not used, printable: "it …", or the sentence of the exception.
template <typename Message, typename Receive, typename Refuse>
ros::Subscriber subscribeChecked(ros::NodeHandle node,
                                 const std::string& topic,
                                 std::uint32_t queue_length,
                                 Receive receive,
                                 Refuse refuse,
                                 const ros::TransportHints& hints = ros::TransportHints()) {
  using Event = ros::MessageEvent<const Checked<Message>>;
  using Pointer = boost::shared_ptr<const Message>;
  const boost::function<void(const Event&)> callback = [receive, refuse](const Event& event) {
    const boost::shared_ptr<const Checked<Message>>& checked = event.getConstMessage();
    if (!checked->defect.empty()) {
      refuse(checked->defect);
      return;
    }
    try {
      const Pointer message(checked, &checked->message);
      if constexpr (std::is_invocable_v<Receive, Pointer, MessageSender>) {
        receive(message,
                MessageSender{event.getPublisherName(), event.getConnectionHeaderPtr().get()});
      } else {
        receive(message);
      }
    } catch (const std::exception& error) {
      refuse(printable(error.what()));
    }
  };
  return node.subscribe<Checked<Message>, const Event&>(
      topic, queue_length, callback, ros::VoidConstPtr(), hints);
}

/// For subscribers that keep no account of what they refuse: tells it on the console, not often.
inline auto tellRefusal(const std::string& topic) {
  return [topic](const std::string& reason) {
    constexpr double kSilence = 2.0;  // [s]
    ROS_WARN_STREAM_THROTTLE(kSilence, topic << ": a message is refused: " << reason);
  };
}

}  // namespace sac
