#include "spherical_actuator_calibration/streams/sliding_extremes.hpp"

namespace sac {
namespace {

/// Forgotten entries are given back only from here on.
constexpr std::size_t kFewestDropped = 64;

}  // namespace

void SlidingExtremes::add(Stamp stamp, double value) {
  smallest_.push({stamp, value});
  largest_.push({stamp, -value});
}

void SlidingExtremes::dropBefore(Stamp stamp) {
  smallest_.dropBefore(stamp);
  largest_.dropBefore(stamp);
}

void SlidingExtremes::clear() {
  smallest_.clear();
  largest_.clear();
}

double SlidingExtremes::spread() const {
  return -largest_.front() - smallest_.front();
}

void SlidingExtremes::Queue::push(const Entry& entry) {
  // An older entry that is not smaller can never be the smallest again.
  while (!empty() && entries.back().value >= entry.value) {
    entries.pop_back();
  }
  if (head >= kFewestDropped && 2 * head >= entries.size()) {
    entries.erase(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(head));
    head = 0;
  }
  entries.push_back(entry);
}

void SlidingExtremes::Queue::dropBefore(Stamp stamp) {
  while (!empty() && entries[head].stamp < stamp) {
    ++head;
  }
}

void SlidingExtremes::Queue::clear() {
  entries.clear();
  head = 0;
}

}  // namespace sac
