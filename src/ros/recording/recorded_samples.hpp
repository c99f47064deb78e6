#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <spherical_actuator_calibration/CalibrationSample.h>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/recording/recording_report.hpp"

namespace sac {

/// Takes the samples of one actuator that were recorded as such. What is not valid, in another
/// frame or recorded twice is dropped, counted and told. Without a torque model torques are
/// ignored.
class RecordedSamples {
 public:
  RecordedSamples(const Actuator& nominal, const MeasurementFrames& frames);

  void add(const msg::CalibrationSample& message);

  /// Samples taken since the last call, as recorded.
  std::vector<Sample> takeSamples() { return std::exchange(samples_, {}); }

  const RecordedSamplesReport& report() const { return report_; }

  /// Throws DataError, naming `files`, when the torque samples are all of another number of coils.
  void requireUsable(const std::string& files) const;

 private:
  Sample usableSample(const msg::CalibrationSample& message);

  const MeasurementFrames& frames_;
  std::size_t coils_;
  bool has_joints_;
  std::vector<Sample> samples_;
  std::set<std::pair<std::uint32_t, Stamp>> known_;
  RecordedSamplesReport report_;
  std::uint64_t torques_ = 0;
  std::uint64_t torques_of_other_size_ = 0;
  std::size_t currents_ = 0;  ///< of the last sample of another size
};

/// Gives numbers of their own to samples whose id another one has before them; sessions count from
/// 1. Returns how many.
std::size_t makeIdsUnique(std::vector<Sample>& samples);

}  // namespace sac
