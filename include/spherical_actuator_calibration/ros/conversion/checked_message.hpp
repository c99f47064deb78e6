#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/array.hpp>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/JointState.h>
#include <spherical_actuator_calibration/CoilCurrents.h>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// A message that comes from outside is not longer than this [byte]: samples of thousands of coils
/// are shorter. Those of streams are short: what is longer is refused before it is read, so that a
/// queue that somebody floods is emptied as quickly as it fills.
template <typename Message>
inline constexpr std::size_t kLargestMessage = std::size_t{4} << 20U;
template <>
inline constexpr std::size_t kLargestMessage<sensor_msgs::JointState> = std::size_t{8} << 10U;
template <>
inline constexpr std::size_t kLargestMessage<msg::CoilCurrents> = std::size_t{16} << 10U;
template <>
inline constexpr std::size_t kLargestMessage<geometry_msgs::QuaternionStamped> =
    std::size_t{4} << 10U;
template <>
inline constexpr std::size_t kLargestMessage<geometry_msgs::Vector3Stamped> = std::size_t{4} << 10U;
template <>
inline constexpr std::size_t kLargestMessage<geometry_msgs::PoseStamped> = std::size_t{4} << 10U;
template <>
inline constexpr std::size_t kLargestMessage<geometry_msgs::WrenchStamped> = std::size_t{4} << 10U;

/// Reads messages from bytes, and believes no length in them before it has seen the bytes. roscpp
/// makes room for as many entries as an array says it has before it looks whether they are there:
/// 200 bytes cost gigabytes. Every read throws std::length_error when the bytes do not suffice.
class CheckedStream {
 public:
  /// The bytes outlive the stream.
  CheckedStream(const std::uint8_t* data, std::size_t size) : next_(data), left_(size) {}

  // What serializers of messages call for each field.

  template <typename Value>
  void next(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      std::memcpy(&value, take(sizeof value), sizeof value);
    } else {
      ros::serialization::Serializer<Value>::read(*this, value);
    }
  }

  template <typename Allocator>
  void next(std::basic_string<char, std::char_traits<char>, Allocator>& text) {
    const std::size_t size = length(1);
    const void* const bytes = take(size);
    text.assign(static_cast<const char*>(bytes), size);
  }

  template <typename Value, typename Allocator>
  void next(std::vector<Value, Allocator>& values) {
    constexpr bool kIsNumber = std::is_arithmetic_v<Value>;
    const std::size_t size = length(kIsNumber ? sizeof(Value) : 1);
    values.clear();
    if constexpr (kIsNumber) {
      values.resize(size);
      if (size > 0) {
        std::memcpy(values.data(), take(size * sizeof(Value)), size * sizeof(Value));
      }
    } else {
      // One by one: each needs bytes of its own before there is room for it.
      for (std::size_t n = 0; n < size; ++n) {
        values.emplace_back();
        next(values.back());
      }
    }
  }

  template <typename Value, std::size_t kSize>
  void next(boost::array<Value, kSize>& values) {
    for (Value& value : values) {
      next(value);
    }
  }

 private:
  /// Number of entries of at least `smallest` bytes each.
  std::size_t length(std::size_t smallest) {
    std::uint32_t entries = 0;
    std::memcpy(&entries, take(sizeof entries), sizeof entries);
    if (entries > left_ / smallest) {
      throw std::length_error("it says that it holds more than its bytes");
    }
    return entries;
  }

  const std::uint8_t* take(std::size_t size) {
    if (size > left_) {
      throw std::length_error("it ends before its last field");
    }
    const std::uint8_t* const begin = next_;
    next_ += size;
    left_ -= size;
    return begin;
  }

  const std::uint8_t* next_;
  std::size_t left_;
};

/// A message as a subscriber takes it instead of `Message`: read by CheckedStream.
template <typename Message>
struct Checked {
  Message message;
  std::string defect;  ///< why the message is not to be used: "it …"; empty: it is whole
};

/// Reads the bytes of a message; what is wrong with them is told by `defect`.
template <typename Message>
void readChecked(const std::uint8_t* data, std::size_t size, Checked<Message>& checked) {
  if (size > kLargestMessage<Message>) {
    checked.defect = "it is " + std::to_string(size) + " bytes long; " +
                     std::to_string(kLargestMessage<Message>) + " are the most that is read";
    return;
  }
  try {
    CheckedStream stream(data, size);
    stream.next(checked.message);
    checked.defect.clear();
  } catch (const std::exception& error) {
    checked.message = Message();
    checked.defect = error.what();
  }
}

}  // namespace sac

namespace ros::message_traits {

template <typename Message>
struct MD5Sum<sac::Checked<Message>> {
  static const char* value() { return MD5Sum<Message>::value(); }
  static const char* value(const sac::Checked<Message>& checked) {
    return MD5Sum<Message>::value(checked.message);
  }
};

template <typename Message>
struct DataType<sac::Checked<Message>> {
  static const char* value() { return DataType<Message>::value(); }
  static const char* value(const sac::Checked<Message>& checked) {
    return DataType<Message>::value(checked.message);
  }
};

template <typename Message>
struct Definition<sac::Checked<Message>> {
  static const char* value() { return Definition<Message>::value(); }
  static const char* value(const sac::Checked<Message>& checked) {
    return Definition<Message>::value(checked.message);
  }
};

}  // namespace ros::message_traits

namespace ros::serialization {

template <typename Message>
struct Serializer<sac::Checked<Message>> {
  template <typename Stream>
  static void read(Stream& stream, sac::Checked<Message>& checked) {
    sac::readChecked(stream.getData(), stream.getLength(), checked);
  }
};

}  // namespace ros::serialization
