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

/// Number at an offset, lowest byte first. Precondition: it is there.
template <typename Number>
Number numberAt(std::string_view bytes, std::size_t offset) {
  static_assert(std::is_unsigned_v<Number>);
  Number number = 0;
  for (std::size_t n = sizeof(Number); n > 0; --n) {
    constexpr unsigned kBitsPerByte = 8;
    const auto byte = static_cast<std::uint8_t>(bytes[offset + n - 1]);
    number = static_cast<Number>((std::uint64_t{number} << kBitsPerByte) | byte);
  }
  return number;
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

/// A record within bytes that are in memory.
struct BagRecord {
  BagFields fields;
  std::string_view data;
  std::size_t end;  ///< offset of what follows
};

/// The record at an offset. Throws BagDefect unless all of it is there.
BagRecord recordAt(std::string_view bytes, std::size_t offset);

}  // namespace sac
