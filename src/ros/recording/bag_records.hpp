#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <boost/container/small_vector.hpp>
#include <boost/endian/conversion.hpp>

namespace sac {

/// What is wrong with the bytes of a bag; what() is a part of a sentence.
class BagDefect : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Kinds of records (wiki.ros.org/Bags/Format/2.0).
enum class BagOp : std::uint8_t {
  kMessageData = 2,
  kBagHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// Bytes of the length that precedes each header and each body.
inline constexpr std::size_t kLengthSize = sizeof(std::uint32_t);

/// Number at an offset, lowest byte first. Precondition: it is there.
template <typename Number>
Number numberAt(std::string_view bytes, std::size_t offset) {
  static_assert(std::is_unsigned_v<Number>);
  Number number = 0;
  std::memcpy(&number, &bytes[offset], sizeof number);
  return boost::endian::little_to_native(number);
}

/// Fields "name=value" of the header of one record, in the bytes that they were parsed from.
class BagFields {
 public:
  /// Throws BagDefect when lengths do not fit, a field has no name, or a name comes twice.
  explicit BagFields(std::string_view bytes);

  /// Empty where there is none.
  std::string_view text(std::string_view name) const;
  /// Throws BagDefect when it is not there, or has another size.
  template <typename Number>
  Number number(std::string_view name) const {
    const std::string_view value = text(name);
    if (value.size() != sizeof(Number)) {
      throw BagDefect("a record has no field \"" + std::string(name) + "\" of its size");
    }
    return numberAt<Number>(value, 0);
  }
  /// Throws BagDefect when the record is of another kind.
  void requireOp(BagOp op) const;
  BagOp op() const { return static_cast<BagOp>(number<std::uint8_t>("op")); }

 private:
  boost::container::small_vector<std::pair<std::string_view, std::string_view>, 8> fields_;
};

/// Finds the messages of one connection in a chunk. Headers of them differ in the value of their
/// time alone: one that is as the one before in all other bytes is not taken apart again.
class MessageRecords {
 public:
  explicit MessageRecords(std::uint32_t connection) : connection_(connection) {}

  /// The message, serialised, of the record at an offset of an unpacked chunk. Throws BagDefect
  /// unless it is whole, and of this connection.
  std::string_view messageAt(std::string_view chunk, std::size_t offset);

 private:
  bool isAsBefore(std::string_view header) const;
  void verify(std::string_view header);

  std::uint32_t connection_;
  std::string verified_;         ///< the header that was taken apart last
  std::size_t time_offset_ = 0;  ///< in it
  std::size_t time_size_ = 0;
};

}  // namespace sac
