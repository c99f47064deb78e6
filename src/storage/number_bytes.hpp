#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace sac {

// Numbers of 4 or 8 bytes as the session database holds them: lowest byte first on every machine,
// each bit kept.

constexpr unsigned kBitsPerByte = 8;

template <typename Value>
using BitsOf =
    std::conditional_t<sizeof(Value) == sizeof(std::uint64_t), std::uint64_t, std::uint32_t>;

template <typename Value>
void appendNumber(std::string& bytes, Value value) {
  BitsOf<Value> bits = 0;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof value);
  for (std::size_t n = 0; n < sizeof value; ++n) {
    bytes.push_back(static_cast<char>(static_cast<unsigned char>(bits >> (kBitsPerByte * n))));
  }
}

/// Inverse of appendNumber(), for the number that begins at `offset`; the caller knows that it is
/// there.
template <typename Value>
Value numberAt(const std::string& bytes, std::size_t offset) {
  BitsOf<Value> bits = 0;
  static_assert(sizeof bits == sizeof(Value));
  for (std::size_t n = 0; n < sizeof bits; ++n) {
    const auto byte = static_cast<unsigned char>(bytes[offset + n]);
    bits |= static_cast<BitsOf<Value>>(byte) << (kBitsPerByte * n);
  }
  Value value{};
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace sac
