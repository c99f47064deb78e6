#include "spherical_actuator_calibration/drivers/modbus_link.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <modbus/modbus.h>

#include <sys/socket.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"
#include "tcp_frame.hpp"

namespace sac {
namespace {

constexpr int kDataBits = 8;
constexpr double kMicrosecondsPerSecond = 1e6;

using Clock = std::chrono::steady_clock;

struct ContextDeleter {
  void operator()(modbus_t* context) const { modbus_free(context); }
};

TransportFailure failureOf(int error) {
  switch (error) {
    case ETIMEDOUT:
      return TransportFailure::kTimeout;
    case EMBBADCRC:
    case EMBBADDATA:
    case EMBBADEXC:
    case EMBUNKEXC:
    case EMBMDATA:
    case EMBBADSLAVE:
      return TransportFailure::kGarbled;
    default:
      break;
  }
  const bool is_exception = error >= EMBXILFUN && error <= EMBXGTAR;
  return is_exception ? TransportFailure::kRefused : TransportFailure::kUnreachable;
}

std::string tableName(RegisterTable table) {
  return table == RegisterTable::kHolding ? "holding register " : "input register ";
}

/// ModbusTransport by libmodbus.
class LibmodbusTransport final : public ModbusTransport {
 public:
  explicit LibmodbusTransport(const ModbusLinkOptions& options)
      : name_(describe(options)),
        response_timeout_(options.response_timeout),
        is_serial_(options.type == ModbusLinkOptions::Type::kRtu),
        context_(newContext(options)) {
    if (!context_) {
      throw ConfigError("link: " + name_ + " cannot be used: " + modbus_strerror(errno) + ".");
    }
    // Without a timeout of its own for every byte, the response timeout is that of the whole
    // answer.
    modbus_set_byte_timeout(context_.get(), 0, 0);
  }
  ~LibmodbusTransport() override { closeLink(); }

  void allow(double seconds) override {
    deadline_ = Clock::now() +
                std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  void open() override {
    if (is_open_) {
      return;
    }
    limitTime();
    if (modbus_connect(context_.get()) != 0) {
      throw TransportError(TransportFailure::kUnreachable,
                           name_ + " cannot be reached: " + modbus_strerror(errno) + ".");
    }
    is_open_ = true;
    if (is_serial_) {
      // What an earlier link has left on the line is no answer to the next request. A new
      // connection has nothing, and one that sends without end would never be empty.
      modbus_flush(context_.get());
    }
  }

  void close() override { closeLink(); }
  bool isOpen() const override { return is_open_; }

  std::vector<std::uint16_t> read(int unit, RegisterTable table, int address, int count) override {
    select(unit);
    const std::string what = tableName(table) + std::to_string(address);
    if (!is_serial_) {
      return ask(TcpFrame::read(++transaction_, {unit, table, address, count}), unit, what);
    }
    std::vector<std::uint16_t> words(static_cast<std::size_t>(count));
    const auto request =
        table == RegisterTable::kHolding ? modbus_read_registers : modbus_read_input_registers;
    if (request(context_.get(), address, count, words.data()) != count) {
      fail(unit, what);
    }
    return words;
  }

  void write(int unit, int address, const std::vector<std::uint16_t>& words) override {
    select(unit);
    const std::string what = tableName(RegisterTable::kHolding) + std::to_string(address);
    if (!is_serial_) {
      ask(TcpFrame::write(++transaction_, unit, address, words), unit, what);
      return;
    }
    const int count = static_cast<int>(words.size());
    if (modbus_write_registers(context_.get(), address, count, words.data()) != count) {
      fail(unit, what);
    }
  }

  std::vector<std::uint16_t> writeAndRead(int unit,
                                          int address,
                                          const std::vector<std::uint16_t>& words,
                                          int read_address,
                                          int count) override {
    select(unit);
    const std::string what = "function 23, " + tableName(RegisterTable::kHolding) +
                             std::to_string(address) + " and " + std::to_string(read_address);
    if (!is_serial_) {
      const RegisterRequest wanted{unit, RegisterTable::kHolding, read_address, count};
      return ask(TcpFrame::writeAndRead(++transaction_, address, words, wanted), unit, what);
    }
    std::vector<std::uint16_t> answer(static_cast<std::size_t>(count));
    if (modbus_write_and_read_registers(context_.get(),
                                        address,
                                        static_cast<int>(words.size()),
                                        words.data(),
                                        read_address,
                                        count,
                                        answer.data()) != count) {
      fail(unit, what);
    }
    return answer;
  }

 private:
  static modbus_t* newContext(const ModbusLinkOptions& options) {
    if (options.type == ModbusLinkOptions::Type::kRtu) {
      return modbus_new_rtu(
          options.device.c_str(), options.baud, options.parity, kDataBits, options.stop_bits);
    }
    return modbus_new_tcp_pi(options.host.c_str(), std::to_string(options.port).c_str());
  }

  void select(int unit) {
    if (!is_open_) {
      throw TransportError(TransportFailure::kUnreachable, name_ + " is not connected.");
    }
    limitTime();
    modbus_set_slave(context_.get(), unit);
  }

  /// What comes next has the response timeout, or what is left of the time that was allowed.
  void limitTime() {
    double seconds = response_timeout_;
    if (deadline_) {
      const double left = std::chrono::duration<double>(*deadline_ - Clock::now()).count();
      if (left < kLeastTime) {
        closeLink();
        throw TransportError(TransportFailure::kTimeout, name_ + " is too slow.");
      }
      seconds = std::min(seconds, left);
    }
    const double whole = std::floor(seconds);
    modbus_set_response_timeout(
        context_.get(),
        static_cast<std::uint32_t>(whole),
        static_cast<std::uint32_t>((seconds - whole) * kMicrosecondsPerSecond));
  }

  /// libmodbus takes any answer of the right transaction, of whatever unit, protocol and length.
  std::vector<std::uint16_t> ask(const TcpFrame& frame, int unit, const std::string& what) {
    const auto size = static_cast<ssize_t>(frame.bytes().size());
    const int socket = modbus_get_socket(context_.get());
    if (::send(socket, frame.bytes().data(), frame.bytes().size(), MSG_NOSIGNAL) != size) {
      fail(unit, what);
    }
    std::vector<std::uint8_t> answer(MODBUS_TCP_MAX_ADU_LENGTH);
    const int received = modbus_receive_confirmation(context_.get(), answer.data());
    if (received < 0) {
      fail(unit, what);
    }
    answer.resize(static_cast<std::size_t>(received));
    const std::string defect = frame.defect(answer);
    if (!defect.empty()) {
      closeLink();
      throw TransportError(TransportFailure::kGarbled,
                           about(unit, what) + "the answer has " + defect + ".");
    }
    if (const std::optional<int> exception = frame.exception(answer)) {
      errno = MODBUS_ENOBASE + *exception;
      fail(unit, what);
    }
    return frame.words(answer);
  }

  std::string about(int unit, const std::string& what) const {
    return name_ + ", unit " + std::to_string(unit) + ", " + what + ": ";
  }

  [[noreturn]] void fail(int unit, const std::string& what) {
    const int error = errno;
    const TransportFailure failure = failureOf(error);
    if (failure != TransportFailure::kRefused) {
      closeLink();
    }
    throw TransportError(failure, about(unit, what) + modbus_strerror(error) + ".");
  }

  void closeLink() {
    if (is_open_) {
      modbus_close(context_.get());
      is_open_ = false;
    }
  }

  /// Less is no time for a request [s].
  static constexpr double kLeastTime = 1e-4;

  std::string name_;
  double response_timeout_;  ///< [s]
  bool is_serial_;
  std::uint16_t transaction_ = 0;  ///< of the last request, over TCP
  std::optional<Clock::time_point> deadline_;
  std::unique_ptr<modbus_t, ContextDeleter> context_;
  bool is_open_ = false;
};

char parityOf(const std::string& word) {
  if (word == "none") {
    return 'N';
  }
  return word == "even" ? 'E' : 'O';
}

}  // namespace

ModbusLinkOptions readModbusLink(const YamlMap& map) {
  ModbusLinkOptions options;
  const bool is_tcp = map.choice("type", {"tcp", "rtu"}) == "tcp";
  options.response_timeout =
      map.number("response_timeout", ValueRange::closed(1e-3, 10.0, "s"), options.response_timeout);
  if (is_tcp) {
    options.type = ModbusLinkOptions::Type::kTcp;
    options.host = map.nonEmptyText("host");
    options.port = static_cast<int>(map.integer("port", 1, 65535, options.port));
    return options;
  }
  options.type = ModbusLinkOptions::Type::kRtu;
  options.device = map.nonEmptyText("device");
  options.baud = static_cast<int>(map.integer("baud", 300, 4'000'000, options.baud));
  options.parity = parityOf(map.choice("parity", {"none", "even", "odd"}, "even"));
  options.stop_bits = static_cast<int>(map.integer("stop_bits", 1, 2, options.stop_bits));
  return options;
}

std::string describe(const ModbusLinkOptions& options) {
  return options.type == ModbusLinkOptions::Type::kRtu
             ? options.device
             : options.host + ":" + std::to_string(options.port);
}

std::unique_ptr<ModbusTransport> makeTransport(const ModbusLinkOptions& options) {
  return std::make_unique<LibmodbusTransport>(options);
}

}  // namespace sac
