#include "spherical_actuator_calibration/ros/view/sample_listing.hpp"

#include <chrono>
#include <utility>

#include <ros/service.h>

#include "spherical_actuator_calibration/ListSamples.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {
namespace {

/// Samples in use by the calibration node; nothing when it does not answer.
std::optional<std::vector<msg::CalibrationSample>> listSamples(const std::string& service) {
  msg::ListSamples list;
  constexpr bool kTellAbsence = false;
  if (!ros::service::exists(service, kTellAbsence) || !ros::service::call(service, list)) {
    return std::nullopt;
  }
  return std::move(list.response.samples);
}

}  // namespace

void SampleListing::update(SampleMirror& mirror) {
  if (!answer_.valid()) {
    if (mirror.takeRequest()) {
      answer_ = std::async(std::launch::async, listSamples, service_);
    }
    return;
  }
  if (answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  if (const auto samples = answer_.get()) {
    mirror.set(*samples);
  } else {
    mirror.repeatRequest();
  }
}

}  // namespace sac
