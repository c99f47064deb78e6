#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "spherical_actuator_calibration/ros/conversion/checked_message.hpp"

namespace sac {

/// Reads messages of a bag into storage that is reused from message to message.
class MessageDecoder {
 public:
  /// Fills `message` from its serialised form and returns it. The type must be the recorded one:
  /// see RecordedTopics. Throws what CheckedStream throws when the bag is damaged. `later`: bytes
  /// of fields that were appended to the type after the recording; they are zero.
  template <typename Message>
  const Message& decode(std::string_view data, Message& message, std::size_t later = 0) {
    if (later > 0) {
      extended_.assign(data.begin(), data.end());
      extended_.append(later, '\0');
      data = extended_;
    }
    const void* const bytes = data.data();
    CheckedStream stream(static_cast<const std::uint8_t*>(bytes), data.size());
    stream.next(message);
    return message;
  }

 private:
  std::string extended_;
};

}  // namespace sac
