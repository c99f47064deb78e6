#include "spherical_actuator_calibration/ros/view/sample_mirror.hpp"

#include <utility>

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
  samples_[message.id] = message;
  recent_.insert(message.id);
  changed_ = true;
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
  std::map<std::uint32_t, msg::CalibrationSample> samples;
  for (const std::uint32_t id : recent_) {
    samples[id] = samples_[id];
  }
  for (const msg::CalibrationSample& sample : in_use) {
    samples[sample.id] = sample;
  }
  samples_ = std::move(samples);
  changed_ = true;
}

bool SampleMirror::takeChange() {
  return std::exchange(changed_, false);
}

}  // namespace sac
