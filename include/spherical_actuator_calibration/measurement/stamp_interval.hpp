#pragma once

#include <cmath>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Ticks of a duration [s], rounded to the nearest.
inline Stamp ticksFromSeconds(double seconds) {
  return static_cast<Stamp>(std::llround(seconds / kSecondsPerTick));
}

/// Span of time with both ends included.
struct StampInterval {
  Stamp begin = 0;
  Stamp end = 0;

  /// Length [s]; negative when the end lies before the begin.
  double duration() const { return secondsBetween(begin, end); }
  Stamp middle() const { return begin + (end - begin) / 2; }
};

}  // namespace sac
