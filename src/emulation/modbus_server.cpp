#include "spherical_actuator_calibration/emulation/modbus_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include <modbus/modbus.h>

#include <netinet/in.h>
#include <sys/socket.h>

#include "spherical_actuator_calibration/drivers/transport_error.hpp"

#include <poll.h>
#include <unistd.h>

namespace sac {
namespace {

constexpr int kRegisters = 65536;        // of a table
constexpr int kLongestQueue = 8;         // of connections that wait
constexpr int kPollTime = 50;            // until a stop is seen [ms]
constexpr std::uint32_t kQuiet = 50000;  // within a request [µs]

std::uint16_t* tableOf(const modbus_mapping_t& mapping, RegisterTable table) {
  return table == RegisterTable::kHolding ? mapping.tab_registers : mapping.tab_input_registers;
}

int boundPort(int socket) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

}  // namespace

class ModbusServer::Listener {
 public:
  Listener(const std::string& address, int port)
      : context_(modbus_new_tcp(address.c_str(), port)),
        socket_(context_ ? modbus_tcp_listen(context_.get(), kLongestQueue) : -1) {
    if (socket_ < 0) {
      throw TransportError(TransportFailure::kUnreachable,
                           address + ":" + std::to_string(port) +
                               " cannot be listened at: " + modbus_strerror(errno) + ".");
    }
    port_ = boundPort(socket_);
    modbus_set_indication_timeout(context_.get(), 0, kQuiet);
    modbus_set_byte_timeout(context_.get(), 0, kQuiet);
    thread_ = std::thread([this] { run(); });
  }

  ~Listener() {
    stopped_ = true;
    thread_.join();
    for (const int client : clients_) {
      ::close(client);
    }
    ::close(socket_);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  int port() const { return port_; }

  void addUnit(int unit) {
    const std::lock_guard<std::mutex> lock(mutex_);
    Mapping& mapping = units_[unit];
    if (!mapping) {
      mapping.reset(modbus_mapping_new(0, 0, kRegisters, kRegisters));
    }
  }

  void setWords(int unit,
                RegisterTable table,
                int address,
                const std::vector<std::uint16_t>& words) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::copy(words.begin(), words.end(), tableOf(*units_.at(unit), table) + address);
  }

  std::vector<std::uint16_t> words(int unit, RegisterTable table, int address, int count) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::uint16_t* first = tableOf(*units_.at(unit), table) + address;
    return {first, first + count};
  }

  void beforeRequest(std::function<void()> function) {
    const std::lock_guard<std::mutex> lock(function_mutex_);
    before_request_ = std::move(function);
  }

 private:
  struct ContextDeleter {
    void operator()(modbus_t* context) const { modbus_free(context); }
  };
  struct MappingDeleter {
    void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
  };
  using Context = std::unique_ptr<modbus_t, ContextDeleter>;
  using Mapping = std::unique_ptr<modbus_mapping_t, MappingDeleter>;

  void run() {
    while (!stopped_) {
      std::vector<pollfd> waiting{{socket_, POLLIN, 0}};
      for (const int client : clients_) {
        waiting.push_back({client, POLLIN, 0});
      }
      if (poll(waiting.data(), waiting.size(), kPollTime) <= 0) {
        continue;
      }
      for (std::size_t n = 1; n < waiting.size(); ++n) {
        if (waiting[n].revents != 0 && !answer(waiting[n].fd)) {
          ::close(waiting[n].fd);
          clients_.erase(std::find(clients_.begin(), clients_.end(), waiting[n].fd));
        }
      }
      if (waiting.front().revents != 0) {
        const int client = ::accept(socket_, nullptr, nullptr);
        if (client >= 0) {
          clients_.push_back(client);
        }
      }
    }
  }

  /// Answers one request; false when the client has gone.
  bool answer(int client) {
    std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request{};
    modbus_set_socket(context_.get(), client);
    const int length = modbus_receive(context_.get(), request.data());
    if (length < 0) {
      return false;
    }
    prepare();
    const auto unit_place = static_cast<std::size_t>(modbus_get_header_length(context_.get())) - 1;
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto unit = units_.find(request.at(unit_place));
    if (unit == units_.end()) {
      modbus_reply_exception(context_.get(), request.data(), MODBUS_EXCEPTION_GATEWAY_TARGET);
      return true;
    }
    return length == 0 ||
           modbus_reply(context_.get(), request.data(), length, unit->second.get()) >= 0;
  }

  /// Without the mutex of the units, which the function may want.
  void prepare() {
    const std::lock_guard<std::mutex> lock(function_mutex_);
    if (before_request_) {
      before_request_();
    }
  }

  Context context_;
  int socket_;
  int port_ = 0;
  std::atomic<bool> stopped_{false};
  std::vector<int> clients_;  ///< of the thread alone
  std::mutex mutex_;          ///< of the units
  std::map<int, Mapping> units_;
  std::mutex function_mutex_;  ///< of the function
  std::function<void()> before_request_;
  std::thread thread_;
};

ModbusServer::ModbusServer(const std::string& address, int port)
    : listener_(std::make_unique<Listener>(address, port)) {}

ModbusServer::~ModbusServer() = default;

int ModbusServer::port() const {
  return listener_->port();
}

void ModbusServer::addUnit(int unit) {
  listener_->addUnit(unit);
}

void ModbusServer::setWords(int unit,
                            RegisterTable table,
                            int address,
                            const std::vector<std::uint16_t>& words) {
  listener_->setWords(unit, table, address, words);
}

std::vector<std::uint16_t> ModbusServer::words(int unit,
                                               RegisterTable table,
                                               int address,
                                               int count) const {
  return listener_->words(unit, table, address, count);
}

void ModbusServer::beforeRequest(std::function<void()> function) {
  listener_->beforeRequest(std::move(function));
}

}  // namespace sac
