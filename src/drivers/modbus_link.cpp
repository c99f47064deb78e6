#include "spherical_actuator_calibration/drivers/modbus_link.hpp"

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <vector>

#include <modbus/modbus.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/drivers/transport_error.hpp"

namespace sac {
namespace {

constexpr int kDataBits = 8;
constexpr double kMicrosecondsPerSecond = 1e6;

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

const char* tableName(RegisterTable table) {
  return table == RegisterTable::kHolding ? "holding register " : "input register ";
}

/// ModbusTransport by libmodbus.
class LibmodbusTransport final : public ModbusTransport {
 public:
  explicit LibmodbusTransport(const ModbusLinkOptions& options)
      : name_(describe(options)), context_(newContext(options)) {
    if (!context_) {
      throw ConfigError("link: " + name_ + " cannot be used: " + modbus_strerror(errno) + ".");
    }
    const double whole = std::floor(options.response_timeout);
    const auto seconds = static_cast<std::uint32_t>(whole);
    const auto microseconds =
        static_cast<std::uint32_t>((options.response_timeout - whole) * kMicrosecondsPerSecond);
    modbus_set_response_timeout(context_.get(), seconds, microseconds);
    modbus_set_byte_timeout(context_.get(), seconds, microseconds);
  }
  ~LibmodbusTransport() override { closeLink(); }

  void open() override {
    if (is_open_) {
      return;
    }
    if (modbus_connect(context_.get()) != 0) {
      throw TransportError(TransportFailure::kUnreachable,
                           name_ + " cannot be reached: " + modbus_strerror(errno) + ".");
    }
    is_open_ = true;
    // What an earlier link has left on a serial line is no answer to the next request.
    modbus_flush(context_.get());
  }

  void close() override { closeLink(); }
  bool isOpen() const override { return is_open_; }

  std::vector<std::uint16_t> read(int unit, RegisterTable table, int address, int count) override {
    select(unit);
    std::vector<std::uint16_t> words(static_cast<std::size_t>(count));
    const auto request =
        table == RegisterTable::kHolding ? modbus_read_registers : modbus_read_input_registers;
    if (request(context_.get(), address, count, words.data()) != count) {
      fail(unit, tableName(table) + std::to_string(address));
    }
    return words;
  }

  void write(int unit, int address, const std::vector<std::uint16_t>& words) override {
    select(unit);
    const int count = static_cast<int>(words.size());
    if (modbus_write_registers(context_.get(), address, count, words.data()) != count) {
      fail(unit, tableName(RegisterTable::kHolding) + std::to_string(address));
    }
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
    modbus_set_slave(context_.get(), unit);
  }

  [[noreturn]] void fail(int unit, const std::string& what) {
    const int error = errno;
    const TransportFailure failure = failureOf(error);
    if (failure != TransportFailure::kRefused) {
      closeLink();
    }
    throw TransportError(failure,
                         name_ + ", unit " + std::to_string(unit) + ", " + what + ": " +
                             modbus_strerror(error) + ".");
  }

  void closeLink() {
    if (is_open_) {
      modbus_close(context_.get());
      is_open_ = false;
    }
  }

  std::string name_;
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
