#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/drivers/modbus_transport.hpp"
#include "spherical_actuator_calibration/drivers/register_codec.hpp"

namespace sac {

/// Addresses of words are 0 to this.
constexpr std::int64_t kLargestAddress = 65535;

/// One number, or a block of numbers of one kind, in the registers of a device:
/// value = sign · scale · (register − zero).
struct RegisterField {
  int unit = 1;  ///< Modbus address of the device
  RegisterTable table = RegisterTable::kHolding;
  int address = 0;  ///< of the first word, counted from 0
  RegisterType type = RegisterType::kInt16;
  WordOrder order = WordOrder::kHighFirst;
  double scale = 1.0;  ///< value per count, > 0
  double zero = 0.0;   ///< count at which the value is 0
  int sign = 1;        ///< +1 or −1

  int words() const { return static_cast<int>(wordCount(type)); }
  /// Value of the number whose words begin at `from`.
  double decode(const std::uint16_t* from) const {
    return sign * scale * (decodeRegisters(from, type, order) - zero);
  }
  /// Words of a value; throws DataError when it does not fit.
  std::vector<std::uint16_t> encode(double value) const {
    return encodeRegisters(sign * value / scale + zero, type, order);
  }
};

/// Reads the keys unit, table (holding, input), address, type, word_order (high_first, low_first),
/// scale, zero and sign from a map, whose other keys are the caller's. Throws ConfigError that
/// names the key.
RegisterField readRegisterField(const YamlMap& map);

}  // namespace sac
