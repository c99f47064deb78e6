/// Bounds of the lengths that a peer of ROS may announce.
///
/// roscpp makes room for what a peer announces, up to a gigabyte, before anything of it has come:
/// three connections and twelve bytes end a node that has a limit of memory, and one peer fills the
/// memory of the computer. roscpp has no setting for it. These four functions are its own, which
/// are looked up in the program first: they refuse what is too long, and leave the rest to roscpp.
///
/// Linked into every node, which must export them (ENABLE_EXPORTS).

#include "announced_lengths.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <boost/shared_array.hpp>
#include <ros/connection.h>
#include <ros/console.h>
#include <ros/service_client_link.h>
#include <ros/service_server_link.h>
#include <ros/transport_publisher_link.h>

#include <dlfcn.h>

namespace {

constexpr double kWarningPeriod = 2.0;  // [s]

using Buffer = boost::shared_array<std::uint8_t>;

/// The address of a function that is no virtual one, as the compilers of this platform have it.
template <typename Function>
void* addressOf(Function function) {
  void* address = nullptr;
  static_assert(sizeof function >= sizeof address);
  std::memcpy(&address, &function, sizeof address);
  return address;
}

/// roscpp's own function of the name of one here.
template <typename Object, typename Function>
auto original(Function function) {
  using Original = void (*)(Object*, const ros::ConnectionPtr&, const Buffer&, std::uint32_t, bool);
  Dl_info here = {};
  void* next = nullptr;
  if (::dladdr(addressOf(function), &here) != 0 && here.dli_sname != nullptr) {
    next = ::dlsym(RTLD_NEXT, here.dli_sname);
  }
  if (next == nullptr) {
    std::fprintf(stderr,
                 "roscpp is not as it was when this program was built: build the package anew.\n");
    std::abort();
  }
  return reinterpret_cast<Original>(next);
}

/// Whether a length of four bytes at a place is more than is allowed.
bool isTooLong(const Buffer& buffer, std::size_t place, std::uint32_t longest, const char* what) {
  std::uint32_t length = 0;
  std::memcpy(&length, buffer.get() + place, sizeof length);
  if (length <= longest) {
    return false;
  }
  ROS_ERROR_STREAM_THROTTLE(kWarningPeriod,
                            "A peer announces a " << what << " of " << length
                                                  << " bytes, and is not listened to any more: "
                                                  << longest << " are the most. End the program "
                                                  << "that sends it.");
  return true;
}

}  // namespace

namespace ros {

void Connection::onHeaderLengthRead(const ConnectionPtr& connection,
                                    const Buffer& buffer,
                                    std::uint32_t size,
                                    bool success) {
  static const auto next = original<Connection>(&Connection::onHeaderLengthRead);
  if (success && isTooLong(buffer, 0, sac::kLongestHeader, "header")) {
    drop(HeaderError);
    return;
  }
  next(this, connection, buffer, size, success);
}

void TransportPublisherLink::onMessageLength(const ConnectionPtr& connection,
                                             const Buffer& buffer,
                                             std::uint32_t size,
                                             bool success) {
  static const auto next =
      original<TransportPublisherLink>(&TransportPublisherLink::onMessageLength);
  if (success && isTooLong(buffer, 0, sac::kLongestMessage, "message")) {
    drop();
    return;
  }
  next(this, connection, buffer, size, success);
}

void ServiceClientLink::onRequestLength(const ConnectionPtr& connection,
                                        const Buffer& buffer,
                                        std::uint32_t size,
                                        bool success) {
  static const auto next = original<ServiceClientLink>(&ServiceClientLink::onRequestLength);
  if (success && isTooLong(buffer, 0, sac::kLongestMessage, "request")) {
    connection->drop(Connection::Destructing);
    return;
  }
  next(this, connection, buffer, size, success);
}

void ServiceServerLink::onResponseOkAndLength(const ConnectionPtr& connection,
                                              const Buffer& buffer,
                                              std::uint32_t size,
                                              bool success) {
  static const auto next = original<ServiceServerLink>(&ServiceServerLink::onResponseOkAndLength);
  // The first byte says whether the service has failed.
  if (success && isTooLong(buffer, 1, sac::kLongestMessage, "response")) {
    connection->drop(Connection::Destructing);
    return;
  }
  next(this, connection, buffer, size, success);
}

}  // namespace ros
