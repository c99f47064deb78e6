#pragma once

#include <cstdint>
#include <vector>

namespace sac {

/// The two register tables of a Modbus device that hold 16-bit words.
enum class RegisterTable {
  kHolding,  ///< read and written (functions 3, 6, 16)
  kInput,    ///< only read (function 4)
};

/// A Modbus bus as its master sees it. One request at a time; not thread-safe.
///
/// Addresses count from 0, as in the protocol. Every request throws TransportError, at the latest
/// when the response timeout is over for its whole answer, however it dribbles in, or when the time
/// of allow() is. After kUnreachable, kTimeout and kGarbled the link is closed: open()
/// makes a new one, so that a late answer cannot be taken for the next one.
class ModbusTransport {
 public:
  ModbusTransport() = default;
  ModbusTransport(const ModbusTransport&) = delete;
  ModbusTransport& operator=(const ModbusTransport&) = delete;
  virtual ~ModbusTransport() = default;

  /// All that follows, until this is called again, must be done within so many seconds from now.
  virtual void allow(double seconds) = 0;

  /// Does nothing when the link is open. Throws TransportError (kUnreachable).
  virtual void open() = 0;
  virtual void close() = 0;
  virtual bool isOpen() const = 0;

  /// `count` words from `address` on, 1 ≤ count ≤ 125.
  virtual std::vector<std::uint16_t> read(int unit,
                                          RegisterTable table,
                                          int address,
                                          int count) = 0;

  /// Writes holding registers from `address` on, 1 to 123 words, in one request.
  virtual void write(int unit, int address, const std::vector<std::uint16_t>& words) = 0;

  /// Writes holding registers from `address` on, 1 to 121 words, then reads `count` ones from
  /// `read_address` on, 1 ≤ count ≤ 125, all by one request (function 23). Not every device knows
  /// it.
  virtual std::vector<std::uint16_t> writeAndRead(int unit,
                                                  int address,
                                                  const std::vector<std::uint16_t>& words,
                                                  int read_address,
                                                  int count) = 0;
};

}  // namespace sac
