#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/sample_mirror.hpp"

namespace sac {

/// Asks the calibration node for the samples in use whenever a mirror needs them. The service may
/// take as long as a cycle: its answer is waited for aside.
class SampleListing {
 public:
  /// `service`: resolved name of list_samples.
  explicit SampleListing(std::string service) : service_(std::move(service)) {}

  /// Asks, or hands over an answer that has come. Called again and again; never waits.
  void update(SampleMirror& mirror);

 private:
  std::string service_;
  std::future<std::optional<std::vector<msg::CalibrationSample>>> answer_;
};

}  // namespace sac
