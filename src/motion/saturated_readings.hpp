#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "motion_span.hpp"

namespace sac {

/// Where a column of readings ends, counted from 0.
struct RangeEnd {
  std::size_t column = 0;
  double value = 0.0;
};

/// Readings that look like the end of a sensor's range, while what they measure goes on: again and
/// again several in a row are the largest of all to the last digit, and few come near. So do
/// setpoints at the limit of a controller, which are sound: the motion tells. What noise goes
/// through after the end of a range is not found.
class SaturatedReadings {
 public:
  /// Keeps a reference. Spans of one actuator.
  explicit SaturatedReadings(const std::vector<MotionSpan>& spans);

  /// Which reading is so within a window, of currents also within `largest_delay` [s] around it, in
  /// words; empty: none.
  std::string within(const MotionWindow& window, double largest_delay) const;

 private:
  const std::vector<MotionSpan>& spans_;
  std::vector<RangeEnd> of_coils_;   ///< [A]
  std::vector<RangeEnd> of_joints_;  ///< [rad]
};

}  // namespace sac
