#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "spherical_actuator_calibration/CalibrationSample.h"
#include "spherical_actuator_calibration/CalibrationStatus.h"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// The samples that the calibration node has in use, kept by whoever listens to its topics:
/// `samples` tells of new ones, `status` when some were taken away; then the list of those in use
/// is asked for (SampleListing).
///
/// Messages may come from anybody: samples that do not fit the actuator are refused, and of more
/// than kMost the oldest are left out.
class SampleMirror {
 public:
  static constexpr std::size_t kMost = 20000;

  /// `coils`: of the actuator.
  explicit SampleMirror(std::size_t coils) : coils_(coils) {}

  /// Throws DataError, "it …", when the sample has another number of currents than there are coils,
  /// and not none.
  void receive(const msg::CalibrationSample& message);
  void receive(const msg::CalibrationStatus& message);

  /// True, once, when samples are held, or were taken away, that did not come by receive(): then
  /// the list of those in use must be asked for.
  bool takeRequest();
  /// Takes the answer: the samples in use. Those that came by receive() since the request stay.
  void set(const std::vector<msg::CalibrationSample>& in_use);
  /// Without an answer: the request stands again.
  void repeatRequest() { needs_samples_ = true; }

  /// True when the samples have changed since the last call.
  bool takeChange();

  /// By their numbers, without names of frames.
  const std::map<std::uint32_t, msg::CalibrationSample>& samples() const { return samples_; }

 private:
  void keep(const msg::CalibrationSample& message);
  bool fits(const msg::CalibrationSample& message) const;

  std::size_t coils_;
  std::map<std::uint32_t, msg::CalibrationSample> samples_;
  std::optional<std::vector<std::uint32_t>> held_;  ///< numbers of samples by the last status
  bool needs_samples_ = false;
  std::set<std::uint32_t> recent_;  ///< samples that came since the last request
  bool changed_ = false;
};

}  // namespace sac
