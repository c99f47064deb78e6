#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/drivers/modbus_transport.hpp"

namespace sac {

/// Modbus TCP devices behind one port, for emulated laboratories (libmodbus). It answers in a
/// thread of its own; every function may be called from any thread.
class ModbusServer {
 public:
  /// Listens at once. `port` 0: any free one. Throws TransportError (kUnreachable) when the port is
  /// taken or the address is not this computer's.
  ModbusServer(const std::string& address, int port);
  ~ModbusServer();
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  int port() const;

  /// Adds a device, unless it is there already; requests to others are refused by a Modbus
  /// exception. All registers are 0 at first.
  void addUnit(int unit);

  /// Words from `address` on, counted from 0; precondition: the unit was added. A request sees all
  /// words of one call, or none.
  void setWords(int unit,
                RegisterTable table,
                int address,
                const std::vector<std::uint16_t>& words);
  std::vector<std::uint16_t> words(int unit, RegisterTable table, int address, int count) const;

  /// Called in the thread of the server before it looks at a request, so that registers may be
  /// those of that time; it must not throw. An empty function takes it away: when this returns, it
  /// is not called any more.
  void beforeRequest(std::function<void()> function);

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace sac
