#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <ros/service.h>

#include "spherical_actuator_calibration/ListRevisions.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// What a service answered, or why it did not.
struct ServiceAnswer {
  bool success = false;
  std::string message;                   ///< one sentence
  std::vector<msg::Revision> revisions;  ///< of list_revisions
  bool is_partial = false;               ///< some are left out; the message tells which
};

/// Calls one service at a time, aside, so that a window stays alive during a long cycle.
class ServiceCaller {
 public:
  bool isBusy() const { return answer_.valid(); }

  /// Starts a call. Precondition: !isBusy().
  template <typename Service>
  void call(const std::string& name, const typename Service::Request& request) {
    answer_ = std::async(std::launch::async, [name, request]() -> ServiceAnswer {
      Service service;
      service.request = request;
      constexpr bool kTellAbsence = false;
      if (!ros::service::exists(name, kTellAbsence)) {
        return {false, "Nobody answers (" + name + "): is its node running?", {}};
      }
      if (!ros::service::call(name, service)) {
        return {false, "The connection to " + name + " was lost before its answer.", {}};
      }
      ServiceAnswer answer{service.response.success != 0, service.response.message, {}};
      if constexpr (std::is_same_v<Service, msg::ListRevisions>) {
        answer.revisions = service.response.revisions;
        answer.is_partial = !service.response.unread.empty();
      }
      return answer;
    });
  }

  /// The answer, once, when it has come.
  std::optional<ServiceAnswer> takeAnswer() {
    if (!answer_.valid() ||
        answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      return std::nullopt;
    }
    return answer_.get();
  }

 private:
  std::future<ServiceAnswer> answer_;
};

}  // namespace sac
