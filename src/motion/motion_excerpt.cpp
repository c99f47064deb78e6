#include "spherical_actuator_calibration/motion/motion_excerpt.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "spherical_actuator_calibration/measurement/stamp_interval.hpp"

namespace sac {
namespace {

double durationOf(const MotionStreams& streams) {
  return streams.joint_stamps.empty()
             ? 0.0
             : secondsBetween(streams.joint_stamps.front(), streams.joint_stamps.back());
}

/// Places of stamps within an interval.
struct Places {
  std::size_t first = 0;
  std::size_t count = 0;

  template <typename T>
  LongSeries<T> of(const LongSeries<T>& all) const {
    LongSeries<T> some;
    for (std::size_t n = first; n < first + count; ++n) {
      some.push_back(all[n]);
    }
    return some;
  }
  StreamCurrents of(const StreamCurrents& all) const {
    StreamCurrents some;
    for (std::size_t n = first; n < first + count; ++n) {
      some.addRow(all.row(static_cast<Eigen::Index>(n)));
    }
    return some;
  }
};

Places placesWithin(const LongSeries<Stamp>& stamps, const StampInterval& interval) {
  const auto begin = std::lower_bound(stamps.begin(), stamps.end(), interval.begin);
  const auto end = std::upper_bound(begin, stamps.end(), interval.end);
  return {static_cast<std::size_t>(begin - stamps.begin()), static_cast<std::size_t>(end - begin)};
}

MotionStreams part(const MotionStreams& all, const StampInterval& interval) {
  const Places joints = placesWithin(all.joint_stamps, interval);
  const Places currents = placesWithin(all.current_stamps, interval);
  const Places orientations = placesWithin(all.orientation_stamps, interval);
  MotionStreams result;
  result.joint_stamps = joints.of(all.joint_stamps);
  result.joints = joints.of(all.joints);
  result.current_stamps = currents.of(all.current_stamps);
  result.currents = currents.of(all.currents);
  result.response = all.response;
  if (all.commanded != nullptr) {
    result.commanded = std::make_shared<const CommandedCurrents>(
        CommandedCurrents{currents.of(all.commanded->currents), all.commanded->response});
  }
  result.orientation_stamps = orientations.of(all.orientation_stamps);
  result.orientations = orientations.of(all.orientations);
  return result;
}

/// Of slices so many, evenly.
MotionRecording someOf(const MotionRecording& recording, std::size_t wanted) {
  MotionRecording result;
  const std::size_t count = std::min(std::max<std::size_t>(1, wanted), recording.spans.size());
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t place = n * recording.spans.size() / count;
    result.spans.push_back(recording.spans[place]);
    result.windows.push_back(recording.windows[place]);
  }
  return result;
}

}  // namespace

MotionRecording motionExcerpt(const MotionRecording& recording, double seconds) {
  if (recording.spans.empty()) {
    return {};
  }
  const auto longest = std::max_element(
      recording.spans.begin(), recording.spans.end(), [](const auto& one, const auto& other) {
        return durationOf(one) < durationOf(other);
      });
  const double duration = durationOf(*longest);
  if (!recording.windows.empty()) {
    return someOf(recording,
                  static_cast<std::size_t>(std::ceil(seconds / std::max(duration, 0.1))));
  }
  if (longest->joint_stamps.empty()) {
    return {};
  }
  const Stamp begin =
      longest->joint_stamps.front() + ticksFromSeconds(std::max(0.0, 0.5 * (duration - seconds)));
  MotionRecording result;
  result.spans.push_back(part(*longest, {begin, begin + ticksFromSeconds(seconds)}));
  return result;
}

}  // namespace sac
