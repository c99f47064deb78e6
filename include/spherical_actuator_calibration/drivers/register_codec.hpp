#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sac {

/// Forms in which devices keep one number in their registers.
enum class RegisterType { kInt16, kUint16, kInt32, kUint32, kFloat32 };

/// Which word of a 32-bit number has the lower address. Within a word Modbus is big-endian.
enum class WordOrder { kHighFirst, kLowFirst };

/// int16, uint16, int32, uint32, float32: as in configurations.
std::string registerTypeName(RegisterType type);
/// Throws ConfigError that names the word when it is no type.
RegisterType registerTypeFromName(const std::string& name);

/// Number of words that a number takes: 1 or 2.
std::size_t wordCount(RegisterType type);

/// The number in the first wordCount(type) words at `words`. Exact; a float32 may be infinite or
/// not a number.
double decodeRegisters(const std::uint16_t* words, RegisterType type, WordOrder order);

/// The words of a number, rounded to the nearest that the type can hold. Throws DataError when it
/// is not finite or beyond the range of the type.
std::vector<std::uint16_t> encodeRegisters(double value, RegisterType type, WordOrder order);

}  // namespace sac
