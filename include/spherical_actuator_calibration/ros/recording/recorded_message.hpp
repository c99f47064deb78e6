#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace sac {

/// The bytes of a message of any type, as it came. Of one that is longer than anything that reads
/// recordings takes, only the length.
struct RecordedMessage {
  static constexpr std::size_t kLargest = std::size_t{4} << 20U;

  std::vector<std::uint8_t> bytes;
  std::size_t length = 0;
};

}  // namespace sac

namespace ros::message_traits {

template <>
struct IsMessage<sac::RecordedMessage> : TrueType {};
template <>
struct IsMessage<const sac::RecordedMessage> : TrueType {};
template <>
struct MD5Sum<sac::RecordedMessage> {
  static const char* value() { return "*"; }
  static const char* value(const sac::RecordedMessage& /*message*/) { return value(); }
};
template <>
struct DataType<sac::RecordedMessage> {
  static const char* value() { return "*"; }
  static const char* value(const sac::RecordedMessage& /*message*/) { return value(); }
};
template <>
struct Definition<sac::RecordedMessage> {
  static const char* value() { return ""; }
  static const char* value(const sac::RecordedMessage& /*message*/) { return value(); }
};

}  // namespace ros::message_traits

namespace ros::serialization {

template <>
struct Serializer<sac::RecordedMessage> {
  template <typename Stream>
  static void read(Stream& stream, sac::RecordedMessage& message) {
    message.length = stream.getLength();
    message.bytes.clear();
    if (message.length <= sac::RecordedMessage::kLargest) {
      message.bytes.assign(stream.getData(), stream.getData() + message.length);
    }
  }
};

}  // namespace ros::serialization
