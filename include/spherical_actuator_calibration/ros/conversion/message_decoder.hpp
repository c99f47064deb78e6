#pragma once

#include <cstdint>
#include <vector>

#include <rosbag/message_instance.h>

#include "spherical_actuator_calibration/ros/conversion/checked_message.hpp"

namespace sac {

/// Reads messages of a bag into storage that is reused from message to message;
/// MessageInstance::instantiate() would allocate each anew.
class MessageDecoder {
 public:
  /// Fills `message` and returns it. The type must be the recorded one: see RecordedTopics. Throws
  /// what rosbag and CheckedStream throw when the bag is damaged.
  /// `later`: bytes of fields that were appended to the type after the recording; they are zero.
  template <typename Message>
  const Message& decode(const rosbag::MessageInstance& instance,
                        Message& message,
                        std::size_t later = 0) {
    instance.write(bytes_);
    bytes_.append(later);
    CheckedStream stream(bytes_.data(), bytes_.size());
    stream.next(message);
    return message;
  }

 private:
  /// Takes the bytes of one message, as MessageInstance::write() gives them.
  class Bytes {
   public:
    std::uint8_t* advance(std::uint32_t size) {
      bytes_.resize(size);
      return bytes_.data();
    }
    void append(std::size_t zeros) { bytes_.resize(bytes_.size() + zeros, 0); }
    std::uint8_t* data() { return bytes_.data(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(bytes_.size()); }

   private:
    std::vector<std::uint8_t> bytes_;
  };

  Bytes bytes_;
};

}  // namespace sac
