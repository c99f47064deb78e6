#include "recorded_samples.hpp"

#include <algorithm>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/frame_names.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "spherical_actuator_calibration/ros/conversion/msg_conversion.hpp"
#include "spherical_actuator_calibration/ros/recording/recorded_streams.hpp"

namespace sac {

RecordedSamples::RecordedSamples(const Actuator& nominal, const MeasurementFrames& frames)
    : frames_(frames), coils_(modelledCoils(nominal)), has_joints_(nominal.has_joints) {}

void RecordedSamples::add(const msg::CalibrationSample& message) {
  ++report_.received;
  try {
    Sample sample = usableSample(message);
    if (known_.insert({sample.id, sample.stamp}).second) {
      samples_.push_back(std::move(sample));
    } else {
      ++report_.repeated;
    }
  } catch (const DataError& error) {
    ++report_.invalid;
    if (report_.invalid_reasons.size() < RecordedSamplesReport::kMaxReasons) {
      report_.invalid_reasons.emplace_back(error.what());
    }
  }
}

Sample RecordedSamples::usableSample(const msg::CalibrationSample& message) {
  const std::string& frame = message.header.frame_id;
  if (!frame.empty() && !isFrame(frame, frames_.stator)) {
    throw DataError("Sample " + std::to_string(message.id) + ": " +
                    otherFrame(frame, frames_.stator) + ".");
  }
  Sample sample = sampleFromRos(message);
  sample.has_torque = sample.has_torque && coils_ > 0;
  if (sample.has_torque) {
    ++torques_;
  }
  if (sample.has_torque && message.current.size() != coils_) {
    ++torques_of_other_size_;
    currents_ = message.current.size();
  }
  validate(sample, coils_);
  return has_joints_ ? sample : trackedSample(sample, sample.orientation_stddev);
}

void RecordedSamples::requireUsable(const std::string& files) const {
  if (torques_ > 0 && torques_of_other_size_ == torques_) {
    throw DataError(coilMismatch(files, "samples have", currents_, coils_));
  }
}

std::size_t makeIdsUnique(std::vector<Sample>& samples) {
  std::uint32_t largest = 0;
  for (const Sample& sample : samples) {
    largest = std::max(largest, sample.id);
  }
  std::set<std::uint32_t> used;
  std::size_t renumbered = 0;
  for (Sample& sample : samples) {
    if (!used.insert(sample.id).second) {
      sample.id = ++largest;
      ++renumbered;
    }
  }
  return renumbered;
}

}  // namespace sac
