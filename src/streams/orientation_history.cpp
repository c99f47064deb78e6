#include "spherical_actuator_calibration/streams/orientation_history.hpp"

#include <algorithm>
#include <iterator>

#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"

namespace sac {

OrientationHistory::OrientationHistory(double span, double largest_gap)
    : span_(ticksFromSeconds(span)), largest_gap_(ticksFromSeconds(largest_gap)) {}

void OrientationHistory::add(const OrientationMeasurement& orientation) {
  orientations_.push_back(orientation);
  while (orientations_.front().stamp < orientation.stamp - span_) {
    orientations_.pop_front();
  }
}

OrientationHistory::Lookup OrientationHistory::at(Stamp stamp) const {
  const auto after = std::lower_bound(
      orientations_.begin(),
      orientations_.end(),
      stamp,
      [](const OrientationMeasurement& each, Stamp wanted) { return each.stamp < wanted; });
  if (after == orientations_.end()) {
    return {Answer::kNotYet, {}};
  }
  if (after->stamp == stamp) {
    return {Answer::kKnown, after->q_stator_rotor};
  }
  if (after == orientations_.begin()) {
    return {Answer::kNever, {}};
  }
  const OrientationMeasurement& before = *std::prev(after);
  if (after->stamp - before.stamp > largest_gap_) {
    return {Answer::kNever, {}};
  }
  const double share =
      static_cast<double>(stamp - before.stamp) / static_cast<double>(after->stamp - before.stamp);
  return {Answer::kKnown, before.q_stator_rotor.slerp(share, after->q_stator_rotor)};
}

}  // namespace sac
