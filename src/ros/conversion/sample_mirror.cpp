#include "spherical_actuator_calibration/ros/conversion/sample_mirror.hpp"

#include <string>
#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {
namespace {

/// Number of samples with an orientation, then per coil.
std::vector<std::uint32_t> countsOf(const msg::CalibrationStatus& status) {
  std::vector<std::uint32_t> counts = status.torque_samples;
  counts.insert(counts.begin(), status.orientation_samples);
  return counts;
}

/// Whether samples were taken away between two statuses.
bool hasFewer(const std::vector<std::uint32_t>& before, const std::vector<std::uint32_t>& now) {
  if (before.size() != now.size()) {
    return true;
  }
  for (std::size_t n = 0; n < now.size(); ++n) {
    if (now[n] < before[n]) {
      return true;
    }
  }
  return false;
}

}  // namespace

void SampleMirror::receive(const msg::CalibrationSample& message) {
  if (!fits(message)) {
    throw DataError("it has " + std::to_string(message.current.size()) +
                    " currents, and the actuator " + std::to_string(coils_) + " coils");
  }
  keep(message);
  recent_.insert(message.id);
  while (recent_.size() > kMost) {
    recent_.erase(recent_.begin());
  }
  changed_ = true;
}

bool SampleMirror::fits(const msg::CalibrationSample& message) const {
  return message.current.empty() || message.current.size() == coils_;
}

void SampleMirror::keep(const msg::CalibrationSample& message) {
  msg::CalibrationSample& sample = samples_[message.id];
  sample = message;
  // As long as whoever sends it likes.
  sample.header.frame_id.clear();
  while (samples_.size() > kMost) {
    samples_.erase(samples_.begin());
  }
}

void SampleMirror::receive(const msg::CalibrationStatus& message) {
  std::vector<std::uint32_t> held = countsOf(message);
  // The first status tells of samples from before this program began to listen.
  if (!held_ || hasFewer(*held_, held)) {
    needs_samples_ = true;
  }
  held_ = std::move(held);
}

bool SampleMirror::takeRequest() {
  if (needs_samples_) {
    recent_.clear();
  }
  return std::exchange(needs_samples_, false);
}

void SampleMirror::set(const std::vector<msg::CalibrationSample>& in_use) {
  const std::map<std::uint32_t, msg::CalibrationSample> before = std::exchange(samples_, {});
  for (const std::uint32_t id : recent_) {
    const auto found = before.find(id);
    if (found != before.end()) {
      keep(found->second);
    }
  }
  for (const msg::CalibrationSample& sample : in_use) {
    if (fits(sample)) {
      keep(sample);
    }
  }
  changed_ = true;
}

bool SampleMirror::takeChange() {
  return std::exchange(changed_, false);
}

}  // namespace sac
