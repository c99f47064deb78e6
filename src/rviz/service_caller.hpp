#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <ros/node_handle.h>
#include <ros/service.h>
#include <ros/service_client.h>

#include "spherical_actuator_calibration/ListRevisions.h"
#include "spherical_actuator_calibration/ListSamples.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// What a service answered, or why it did not.
struct ServiceAnswer {
  bool success = false;
  std::string message;                               ///< one sentence
  std::vector<msg::Revision> revisions;              ///< of list_revisions
  bool is_partial = false;                           ///< some are left out; the message tells which
  std::vector<msg::CalibrationSample> samples = {};  ///< of list_samples
};

/// Calls one service at a time, aside, so that a window stays alive during a long cycle. Its end
/// does not wait for an answer: what the service does goes on.
class ServiceCaller {
 public:
  ServiceCaller() = default;
  ~ServiceCaller() {
    while (answer_.valid() &&
           answer_.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      link_->cut();
    }
  }
  ServiceCaller(const ServiceCaller&) = delete;
  ServiceCaller& operator=(const ServiceCaller&) = delete;

  bool isBusy() const { return answer_.valid(); }

  /// Starts a call. Precondition: !isBusy().
  template <typename Service>
  void call(const std::string& name, const typename Service::Request& request) {
    link_ = std::make_shared<Link>();
    answer_ = std::async(std::launch::async, [name, request, link = link_]() -> ServiceAnswer {
      Service service;
      service.request = request;
      constexpr bool kTellAbsence = false;
      if (!ros::service::exists(name, kTellAbsence)) {
        return {false, "Nobody answers (" + name + "): is its node running?", {}};
      }
      if (!link->open<Service>(name) || !link->client().call(service)) {
        return {false, "The connection to " + name + " was lost before its answer.", {}};
      }
      return answerOf(service);
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
  template <typename Service>
  static ServiceAnswer answerOf(const Service& service) {
    ServiceAnswer answer;
    if constexpr (std::is_same_v<Service, msg::ListSamples>) {
      answer.success = true;
      answer.samples = service.response.samples;
    } else {
      answer.success = service.response.success != 0;
      answer.message = service.response.message;
    }
    if constexpr (std::is_same_v<Service, msg::ListRevisions>) {
      answer.revisions = service.response.revisions;
      answer.is_partial = !service.response.unread.empty();
    }
    return answer;
  }

  /// A connection of its own, which another thread can cut: a call of a node that stands still
  /// would be waited for.
  class Link {
   public:
    template <typename Service>
    bool open(const std::string& name) {
      const std::lock_guard<std::mutex> lock(mutex_);
      constexpr bool kPersistent = true;
      if (!is_cut_) {
        client_ = ros::NodeHandle().serviceClient<Service>(name, kPersistent);
      }
      return client_.isValid();
    }
    ros::ServiceClient client() const { return client_; }
    void cut() {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_cut_ = true;
      client_.shutdown();
    }

   private:
    std::mutex mutex_;
    ros::ServiceClient client_;
    bool is_cut_ = false;
  };

  std::shared_ptr<Link> link_;
  std::future<ServiceAnswer> answer_;
};

}  // namespace sac
