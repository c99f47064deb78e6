#include "motion_span.hpp"

#include <algorithm>
#include <cmath>

namespace sac {
namespace {

/// Whether currents were measured without a hole from `begin` to `end`.
bool hasCurrents(const MotionSpan& span, double begin, double end) {
  constexpr double kGap = 3.5;  // steps
  const StampTimes& times = span.current_times;
  const double longest = kGap * span.current_step;
  const std::size_t from = times.firstFrom(begin);
  if (from == 0 || times.back() < end) {
    return false;
  }
  for (std::size_t n = from - 1; times[n] < end; ++n) {
    if (times[n + 1] - times[n] > longest) {
      return false;
    }
  }
  return true;
}

/// Readings of a span at which windows may begin and end.
struct ReadingRange {
  std::size_t first;
  std::size_t last;
};

/// Where there are currents, also within the largest delay: the first and the last of `whole`
/// without those that have none.
ReadingRange drivenReadings(const MotionSpan& span,
                            const ReadingRange& whole,
                            double largest_delay) {
  ReadingRange driven = whole;
  if (span.current_times.empty()) {
    return driven;
  }
  const double begin = span.current_times.front() + largest_delay;
  const double end = span.current_times.back() - largest_delay;
  while (driven.first < driven.last && span.track.time(driven.first) <= begin) {
    ++driven.first;
  }
  while (driven.last > driven.first && span.track.time(driven.last) > end) {
    --driven.last;
  }
  return driven;
}

/// Readings between windows of about `length`. They fill what has currents, without a rest; the
/// windows before and after it are there to be refused.
std::vector<std::size_t> bordersOf(const MotionSpan& span,
                                   double largest_delay,
                                   std::size_t length) {
  std::vector<std::size_t> borders;
  if (span.track.size() < 2 * kBeside + length) {
    return borders;
  }
  const ReadingRange whole{kBeside, span.track.size() - 1 - kBeside};
  const ReadingRange driven = drivenReadings(span, whole, largest_delay);
  const std::size_t before = (driven.first - whole.first) / length;
  for (std::size_t n = before; n > 0; --n) {
    borders.push_back(driven.first - n * length);
  }
  const std::size_t count = (driven.last - driven.first) / length;
  for (std::size_t n = 0; n <= count; ++n) {
    const std::size_t share = count == 0 ? 0 : (driven.last - driven.first) * n / count;
    borders.push_back(driven.first + share);
  }
  while (borders.back() + length <= whole.last) {
    borders.push_back(borders.back() + length);
  }
  return borders;
}

/// Fastest joint between readings some steps apart [rad/s].
double largestSpeed(const JointTrack& track, const MotionWindow& window) {
  constexpr std::size_t kParts = 5;
  const std::size_t step = std::max<std::size_t>(1, (window.last - window.first) / kParts);
  double fastest = 0.0;
  for (std::size_t n = window.first; n + step <= window.last; n += step) {
    const double time = track.time(n + step) - track.time(n);
    fastest = std::max(fastest, (track.reading(n + step) - track.reading(n)).norm() / time);
  }
  return fastest;
}

/// Of any coil within a window, by stamps as they are [A].
struct WindowCurrents {
  float usual = 0.0F;    ///< a tenth of the readings may exceed it: no spoilt ones decide it
  float largest = 0.0F;  ///< but for one reading, or two, that a bus may have spoilt
};

WindowCurrents currentsWithin(const MotionSpan& span, const MotionWindow& window) {
  constexpr std::size_t kOneOf = 10;
  constexpr std::size_t kSpoilt = 2;
  const std::size_t begin = span.current_times.firstFrom(span.track.time(window.first));
  const std::size_t end = span.current_times.firstFrom(span.track.time(window.last));
  if (begin + kSpoilt >= end) {
    return {};
  }
  std::vector<float> largest;
  largest.reserve(end - begin);
  for (std::size_t n = begin; n < end; ++n) {
    largest.push_back(
        span.streams->currents.row(static_cast<Eigen::Index>(n)).cwiseAbs().maxCoeff());
  }
  std::sort(largest.begin(), largest.end());
  const std::size_t last = largest.size() - 1;
  return {largest[last - std::min(last, 1 + largest.size() / kOneOf)], largest[last - kSpoilt]};
}

}  // namespace

MotionSpan::MotionSpan(const MotionStreams& recorded)
    : streams(&recorded),
      track(recorded, recorded.joint_stamps.front()),
      current_times(recorded.joint_stamps.front(), recorded.current_stamps),
      orientation_times(recorded.joint_stamps.front(), recorded.orientation_stamps),
      current_step(usualStep(current_times)) {}

void countLeftOut(const std::string& reason, std::vector<WindowsLeftOut>& left_out) {
  const auto place = std::find_if(left_out.begin(), left_out.end(), [&](const WindowsLeftOut& one) {
    return one.reason == reason;
  });
  if (place == left_out.end()) {
    left_out.push_back({reason, 1});
  } else {
    ++place->count;
  }
}

std::string refusalOf(const MotionSpan& span,
                      const MotionWindow& window,
                      const MotionOptions& options) {
  for (std::size_t n = window.first - 1; n <= window.last; ++n) {
    if (!span.track.isWhole(n)) {
      return "joint readings are missing";
    }
  }
  // Sums of fewer are no integrals of currents that change from one to the next.
  constexpr double kLeastCurrents = 10.0;
  const double duration = span.track.time(window.last) - span.track.time(window.first);
  if (duration < kLeastCurrents * span.current_step) {
    return "fewer than ten currents are in it";
  }
  const double begin = span.track.time(window.first) - options.largest_delay;
  const double end = span.track.time(window.last) + options.largest_delay;
  if (!hasCurrents(span, begin, end)) {
    return "currents are missing";
  }
  return largestSpeed(span.track, window) < options.least_speed ? "the rotor rests" : "";
}

bool restsAt(const MotionSpan& span, double time, double least_speed) {
  constexpr double kHalf = 0.05;  // [s]
  const JointTrack& track = span.track;
  const std::size_t begin = track.firstFrom(time - kHalf);
  const std::size_t middle = track.firstFrom(time);
  const std::size_t end = track.firstFrom(time + kHalf);
  if (begin == middle || middle == end) {
    return false;
  }
  // Means, so that the noise of readings is no speed.
  const auto mean = [&track](std::size_t first, std::size_t last) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t n = first; n < last; ++n) {
      sum += track.reading(n);
    }
    return Eigen::Vector3d(sum / static_cast<double>(last - first));
  };
  return (mean(middle, end) - mean(begin, middle)).norm() < least_speed * kHalf;
}

std::vector<MotionWindow> cutWindows(const std::vector<MotionSpan>& spans,
                                     const MotionOptions& options,
                                     std::vector<WindowsLeftOut>& left_out) {
  std::vector<MotionWindow> windows;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    const JointTrack& track = spans[s].track;
    if (track.step() <= 0.0) {
      continue;
    }
    const std::size_t length = std::max(
        kLeastReadings, static_cast<std::size_t>(std::lround(options.window / track.step())));
    const std::vector<std::size_t> borders = bordersOf(spans[s], options.largest_delay, length);
    for (std::size_t n = 0; n + 1 < borders.size(); ++n) {
      const MotionWindow window{s, borders[n], borders[n + 1]};
      const std::string reason = refusalOf(spans[s], window, options);
      if (reason.empty()) {
        windows.push_back(window);
      } else {
        countLeftOut(reason, left_out);
      }
    }
  }
  return windows;
}

std::vector<MotionWindow> drivenWindows(const std::vector<MotionSpan>& spans,
                                        const std::vector<MotionWindow>& windows,
                                        std::vector<WindowsLeftOut>& left_out) {
  constexpr float kLeast = 0.02F;  // of the largest current
  std::vector<WindowCurrents> currents;
  currents.reserve(windows.size());
  float usual = 0.0F;
  for (const MotionWindow& window : windows) {
    currents.push_back(currentsWithin(spans[window.span], window));
    usual = std::max(usual, currents.back().usual);
  }
  std::vector<MotionWindow> driven;
  for (std::size_t n = 0; n < windows.size(); ++n) {
    if (currents[n].largest >= kLeast * usual) {
      driven.push_back(windows[n]);
    } else {
      countLeftOut("no coil carries current", left_out);
    }
  }
  return driven;
}

std::optional<CommandResponse> responseOfLongest(const std::vector<MotionSpan>& spans) {
  std::optional<CommandResponse> response;
  std::size_t longest = 0;
  for (const MotionSpan& span : spans) {
    if (span.streams->response && span.current_times.size() > longest) {
      longest = span.current_times.size();
      response = span.streams->response;
    }
  }
  return response;
}

}  // namespace sac
