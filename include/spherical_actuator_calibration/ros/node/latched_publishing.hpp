#pragma once

#include <cstdint>

#include <ros/publisher.h>

namespace sac {

/// Publishes on a latched topic so that whoever connects meanwhile gets the message. roscpp keeps
/// it for later subscribers only after it was sent to those that are there: one that connects in
/// between would get neither, and would wait for ever for what does not change. It may get it
/// twice.
template <typename Message>
void publishLatched(const ros::Publisher& publisher, const Message& message) {
  const std::uint32_t before = publisher.getNumSubscribers();
  publisher.publish(message);
  if (publisher.getNumSubscribers() != before) {
    publisher.publish(message);
  }
}

}  // namespace sac
