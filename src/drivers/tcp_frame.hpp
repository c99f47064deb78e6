#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/drivers/register_request.hpp"

namespace sac {

/// One request of Modbus TCP, and what a device must answer to it (Modbus messaging on TCP/IP
/// implementation guide V1.0b). All that is known of the answer before it comes must be so:
/// transaction, protocol, length, unit, function, and what it is about. Otherwise it is one to
/// something else, of another device, or damaged.
class TcpFrame {
 public:
  /// Functions 3 and 4.
  static TcpFrame read(std::uint16_t transaction, const RegisterRequest& wanted);
  /// Function 16.
  static TcpFrame write(std::uint16_t transaction,
                        int unit,
                        int address,
                        const std::vector<std::uint16_t>& words);
  /// Function 23: writes, and reads what is wanted.
  static TcpFrame writeAndRead(std::uint16_t transaction,
                               int address,
                               const std::vector<std::uint16_t>& words,
                               const RegisterRequest& wanted);

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  /// What is wrong with an answer, as an object of "the answer has ..."; empty: nothing is.
  std::string defect(const std::vector<std::uint8_t>& answer) const;
  /// The exception code that the device answers instead of doing it, from 1.
  std::optional<int> exception(const std::vector<std::uint8_t>& answer) const;
  /// What was read, of an answer without defect that is no exception.
  std::vector<std::uint16_t> words(const std::vector<std::uint8_t>& answer) const;

 private:
  TcpFrame(std::uint16_t transaction, int unit) : transaction_(transaction), unit_(unit) {}
  std::vector<std::uint8_t> header(std::size_t length) const;
  void finish(const std::vector<std::uint8_t>& body);

  std::uint16_t transaction_;
  int unit_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint8_t> expected_;  ///< how the answer must begin, unless it is an exception
  std::size_t words_read_ = 0;          ///< that come after it
};

}  // namespace sac
