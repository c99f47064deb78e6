#include "spherical_actuator_calibration/drivers/register_codec.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

constexpr std::array<std::pair<RegisterType, const char*>, 5> kNames = {{
    {RegisterType::kInt16, "int16"},
    {RegisterType::kUint16, "uint16"},
    {RegisterType::kInt32, "int32"},
    {RegisterType::kUint32, "uint32"},
    {RegisterType::kFloat32, "float32"},
}};

/// The same bits as another type of the same size.
template <typename To, typename From>
To bitCast(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

template <typename Number>
Number rounded(double value, RegisterType type) {
  const double whole = std::round(value);
  if (!(whole >= static_cast<double>(std::numeric_limits<Number>::lowest()) &&
        whole <= static_cast<double>(std::numeric_limits<Number>::max()))) {
    throw DataError("The value " + std::to_string(value) +
                    " does not fit into a register of type " + registerTypeName(type) + ".");
  }
  return static_cast<Number>(whole);
}

std::uint32_t floatBits(double value) {
  const auto narrow = static_cast<float>(value);
  if (!std::isfinite(narrow)) {
    throw DataError("The value " + std::to_string(value) +
                    " does not fit into a register of type float32.");
  }
  return bitCast<std::uint32_t>(narrow);
}

std::vector<std::uint16_t> twoWords(std::uint32_t bits, WordOrder order) {
  const auto high = static_cast<std::uint16_t>(bits >> 16U);
  const auto low = static_cast<std::uint16_t>(bits & 0xFFFFU);
  if (order == WordOrder::kHighFirst) {
    return {high, low};
  }
  return {low, high};
}

std::uint32_t bitsOf(const std::uint16_t* words, WordOrder order) {
  const std::uint32_t high = order == WordOrder::kHighFirst ? words[0] : words[1];
  const std::uint32_t low = order == WordOrder::kHighFirst ? words[1] : words[0];
  return (high << 16U) | low;
}

}  // namespace

std::string registerTypeName(RegisterType type) {
  return kNames[static_cast<std::size_t>(type)].second;
}

RegisterType registerTypeFromName(const std::string& name) {
  for (const auto& [type, word] : kNames) {
    if (name == word) {
      return type;
    }
  }
  throw ConfigError(name +
                    " is no type of register; int16, uint16, int32, uint32 and float32 are.");
}

std::size_t wordCount(RegisterType type) {
  return type == RegisterType::kInt16 || type == RegisterType::kUint16 ? 1 : 2;
}

double decodeRegisters(const std::uint16_t* words, RegisterType type, WordOrder order) {
  switch (type) {
    case RegisterType::kInt16:
      return static_cast<double>(bitCast<std::int16_t>(words[0]));
    case RegisterType::kUint16:
      return static_cast<double>(words[0]);
    case RegisterType::kInt32:
      return static_cast<double>(bitCast<std::int32_t>(bitsOf(words, order)));
    case RegisterType::kUint32:
      return static_cast<double>(bitsOf(words, order));
    case RegisterType::kFloat32:
      break;
  }
  return static_cast<double>(bitCast<float>(bitsOf(words, order)));
}

std::vector<std::uint16_t> encodeRegisters(double value, RegisterType type, WordOrder order) {
  switch (type) {
    case RegisterType::kInt16:
      return {bitCast<std::uint16_t>(rounded<std::int16_t>(value, type))};
    case RegisterType::kUint16:
      return {rounded<std::uint16_t>(value, type)};
    case RegisterType::kInt32:
      return twoWords(bitCast<std::uint32_t>(rounded<std::int32_t>(value, type)), order);
    case RegisterType::kUint32:
      return twoWords(rounded<std::uint32_t>(value, type), order);
    case RegisterType::kFloat32:
      break;
  }
  return twoWords(floatBits(value), order);
}

}  // namespace sac
