#pragma once

#include <memory>
#include <string>

#include "spherical_actuator_calibration/base/yaml_reader.hpp"
#include "spherical_actuator_calibration/drivers/modbus_transport.hpp"

namespace sac {

/// How a Modbus device is reached.
struct ModbusLinkOptions {
  enum class Type { kTcp, kRtu };
  Type type = Type::kTcp;
  std::string host = "127.0.0.1";  ///< TCP: address or name
  int port = 502;                  ///< TCP
  std::string device;              ///< RTU: serial device, "/dev/ttyUSB0"
  int baud = 115200;               ///< RTU [bit/s]
  char parity = 'E';               ///< RTU: 'N', 'E' or 'O'
  int stop_bits = 1;               ///< RTU
  double response_timeout = 0.1;   ///< of connecting, and of a request's whole answer [s]
};

/// Reads the map `link` of a driver's configuration, for example {type: tcp, host: 127.0.0.1, port:
/// 1502, response_timeout: 0.1} or {type: rtu, device: /dev/ttyUSB0, baud: 115200, parity: even,
/// stop_bits: 1}. Throws ConfigError that names the key.
ModbusLinkOptions readModbusLink(const YamlMap& map);

/// "127.0.0.1:1502" or "/dev/ttyUSB0".
std::string describe(const ModbusLinkOptions& options);

/// The bus by libmodbus; closed at first. Throws ConfigError when the options cannot be used.
std::unique_ptr<ModbusTransport> makeTransport(const ModbusLinkOptions& options);

}  // namespace sac
