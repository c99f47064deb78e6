#include "spherical_actuator_calibration/streams/stream_buffer.hpp"

#include <algorithm>

namespace sac {
namespace {

/// Forgotten entries are given back only from here on, so that short buffers are not moved about.
constexpr std::size_t kSmallestCompaction = 1024;

}  // namespace

void StreamBuffer::push(Stamp stamp, const double* values) {
  if (head_ >= kSmallestCompaction && head_ >= size()) {
    compact();
  }
  stamps_.push_back(stamp);
  values_.insert(values_.end(), values, values + width_);
}

void StreamBuffer::dropBefore(Stamp stamp) {
  while (head_ < stamps_.size() && stamps_[head_] < stamp) {
    ++head_;
  }
}

void StreamBuffer::clear() {
  head_ = 0;
  stamps_.clear();
  values_.clear();
}

StreamBuffer::Range StreamBuffer::within(const StampInterval& interval) const {
  const auto begin = stamps_.begin() + static_cast<std::ptrdiff_t>(head_);
  const auto first = std::lower_bound(begin, stamps_.end(), interval.begin);
  const auto last = std::upper_bound(first, stamps_.end(), std::max(interval.begin, interval.end));
  return {static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - begin)};
}

// Moves the entries to the front. It happens only when at least as many were forgotten as are
// moved, hence constant time per entry on average.
void StreamBuffer::compact() {
  stamps_.erase(stamps_.begin(), stamps_.begin() + static_cast<std::ptrdiff_t>(head_));
  values_.erase(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(head_ * width_));
  head_ = 0;
}

}  // namespace sac
