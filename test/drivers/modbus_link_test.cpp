#include "spherical_actuator_calibration/drivers/modbus_link.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "spherical_actuator_calibration/drivers/transport_error.hpp"

#include <unistd.h>

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A device that accepts one link after another and serves each by a function, which is given the
/// socket and the request of twelve bytes, and says whether the link goes on.
class RudeDevice {
 public:
  explicit RudeDevice(std::function<bool(int, const Bytes&)> answer) : answer_(std::move(answer)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    bind(listener_, reinterpret_cast<sockaddr*>(&address), length);
    listen(listener_, 4);
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~RudeDevice() {
    stopped_ = true;
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
  }
  RudeDevice(const RudeDevice&) = delete;
  RudeDevice& operator=(const RudeDevice&) = delete;

  int port() const { return port_; }

 private:
  void run() {
    while (!stopped_) {
      const int client = accept(listener_, nullptr, nullptr);
      Bytes request(12);
      while (client >= 0 && !stopped_ && recv(client, request.data(), request.size(), 0) == 12 &&
             answer_(client, request)) {
      }
      close(client);
    }
  }

  std::function<bool(int, const Bytes&)> answer_;
  int listener_ = socket(AF_INET, SOCK_STREAM, 0);
  int port_ = 0;
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

bool sendAll(int socket, const Bytes& bytes) {
  return send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

/// The right answer to a request for one register: 7.
Bytes answerTo(const Bytes& request) {
  return {request[0], request[1], 0, 0, 0, 5, request[6], request[7], 2, 0, 7};
}

std::unique_ptr<ModbusTransport> linkTo(const RudeDevice& device, double response_timeout) {
  ModbusLinkOptions options;
  options.port = device.port();
  options.response_timeout = response_timeout;
  std::unique_ptr<ModbusTransport> transport = makeTransport(options);
  transport->open();
  return transport;
}

/// How a request for one register fails; nothing: it does not.
std::optional<TransportFailure> failureOf(ModbusTransport& transport) {
  try {
    transport.read(1, RegisterTable::kHolding, 0, 1);
    return std::nullopt;
  } catch (const TransportError& error) {
    return error.failure();
  }
}

TEST(ModbusLink, AnAnswerThatDribblesHasTheTimeOfOneAnswer) {
  // No byte is late after the one before, but eleven of them take longer than an answer may.
  std::atomic<int> sent{0};
  const RudeDevice device([&](int socket, const Bytes& request) {
    for (const std::uint8_t byte : answerTo(request)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
      if (!sendAll(socket, {byte})) {
        return false;
      }
      ++sent;
    }
    return true;
  });
  const auto transport = linkTo(device, 0.4);
  EXPECT_EQ(failureOf(*transport), TransportFailure::kTimeout);
  EXPECT_FALSE(transport->isOpen());
  EXPECT_LT(sent, 11);
}

TEST(ModbusLink, AllRequestsTogetherHaveTheTimeThatIsAllowed) {
  const RudeDevice device([&](int socket, const Bytes& request) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return sendAll(socket, answerTo(request));
  });
  const auto transport = linkTo(device, 30.0);
  transport->allow(30.0);
  EXPECT_EQ(failureOf(*transport), std::nullopt);
  transport->allow(0.12);
  int answered = 0;
  while (failureOf(*transport) == std::nullopt && answered < 100) {
    ++answered;
  }
  EXPECT_LE(answered, 2);
  EXPECT_FALSE(transport->isOpen());
  // Nothing is begun when the time is over.
  EXPECT_THROW(transport->open(), TransportError);
  transport->allow(30.0);
  transport->open();
  EXPECT_EQ(failureOf(*transport), std::nullopt);
}

TEST(ModbusLink, AnEndlessAnswerIsNoAnswer) {
  const RudeDevice device([&](int socket, const Bytes& request) {
    if (!sendAll(socket, answerTo(request))) {
      return false;
    }
    while (sendAll(socket, Bytes(4096, 0x55))) {
    }
    return false;
  });
  const auto transport = linkTo(device, 30.0);
  // The first answer is complete before the flood; the second one is not to the request.
  EXPECT_EQ(failureOf(*transport), std::nullopt);
  EXPECT_EQ(failureOf(*transport), TransportFailure::kGarbled);
  EXPECT_FALSE(transport->isOpen());
  transport->open();
  EXPECT_EQ(failureOf(*transport), std::nullopt);
}

struct WrongByte {
  std::size_t place;
  const char* name;
};

TEST(ModbusLink, AnAnswerToAnotherRequestIsNoAnswer) {
  for (const WrongByte& wrong : {WrongByte{0, "transaction id"},
                                 {1, "transaction id"},
                                 {2, "protocol id"},
                                 {3, "protocol id"},
                                 {4, "length"},
                                 {5, "length"},
                                 {6, "unit id"},
                                 {7, "function"}}) {
    const RudeDevice device([&](int socket, const Bytes& request) {
      Bytes answer = answerTo(request);
      ++answer[wrong.place];
      return sendAll(socket, answer);
    });
    const auto transport = linkTo(device, 30.0);
    try {
      transport->read(1, RegisterTable::kHolding, 0, 1);
      ADD_FAILURE() << "a wrong " << wrong.name << " is accepted";
    } catch (const TransportError& error) {
      EXPECT_EQ(error.failure(), TransportFailure::kGarbled) << wrong.name;
      EXPECT_NE(std::string(error.what()).find(wrong.name), std::string::npos) << error.what();
    }
    EXPECT_FALSE(transport->isOpen()) << wrong.name;
  }
}

}  // namespace
}  // namespace sac
