#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "motion_span.hpp"

namespace sac {

/// One of some parts of a window, of equally many readings each.
struct WindowPart {
  std::size_t index = 0;
  std::size_t count = 1;
};

/// Where a part of so many begins, and ends.
inline std::size_t beginOf(std::size_t total, const WindowPart& part) {
  return total * part.index / part.count;
}
inline std::size_t endOf(std::size_t total, const WindowPart& part) {
  return beginOf(total, {part.index + 1, part.count});
}

/// A measurement of the currents within a window.
struct CurrentReading {
  std::size_t row = 0;  ///< of the span's currents
  double time = 0.0;    ///< at which they flowed, by the clock of the joints [s]
  double before = 0.0;  ///< since those that count before [s]
  double after = 0.0;   ///< to those that count next [s]
  TrackPoint track;     ///< of the joints then

  /// What they count for [s].
  double step() const { return 0.5 * (before + after); }
};

/// Readings [first, last) of the currents within a window, whose stamps are later by `delay` [s]
/// than what they tell: each has `beside` others on both sides.
struct CurrentRange {
  CurrentRange(const MotionSpan& span, const MotionWindow& window, double delay, std::size_t beside)
      : first(
            std::max(span.current_times.firstAfter(span.track.time(window.first) + delay), beside)),
        last(std::min(span.current_times.firstFrom(span.track.time(window.last) + delay),
                      std::max(span.current_times.size(), beside) - beside)) {}

  std::size_t size() const { return last > first ? last - first : 0; }

  std::size_t first;
  std::size_t last;
};

/// Calls visit(CurrentReading) for every `stride`th of a part of those within a window, whose
/// stamps are later by `delay` [s] than what they tell. Each has neighbours on both sides, and
/// readings of the joints around it.
template <typename Visit>
void visitCurrents(const MotionSpan& span,
                   const MotionWindow& window,
                   double delay,
                   std::size_t stride,
                   const WindowPart& part,
                   const Visit& visit) {
  const StampTimes& times = span.current_times;
  const CurrentRange range(span, window, delay, stride);
  const std::size_t count = (range.size() + stride - 1) / stride;
  for (std::size_t m = beginOf(count, part); m < endOf(count, part); ++m) {
    const std::size_t n = range.first + m * stride;
    const std::optional<TrackPoint> track = span.track.at(times[n] - delay);
    if (track) {
      visit(CurrentReading{
          n, times[n] - delay, times[n] - times[n - stride], times[n + stride] - times[n], *track});
    }
  }
}

}  // namespace sac
