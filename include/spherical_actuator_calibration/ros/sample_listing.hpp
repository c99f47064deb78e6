#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/ros/sample_mirror.hpp"

namespace spherical_actuator_calibration {

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
  std::future<std::optional<std::vector<CalibrationSample>>> answer_;
};

}  // namespace spherical_actuator_calibration
