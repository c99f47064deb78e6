#include "command_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "joint_track.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"

namespace sac {

CommandComparison::CommandComparison(const MotionStreams& streams, const CommandStream& commands)
    : streams_(streams),
      commands_(commands),
      times_(secondsFrom(streams.current_stamps.front(), streams.current_stamps)),
      command_times_(secondsFrom(streams.current_stamps.front(), commands.stamps)) {}

std::size_t CommandComparison::sampleAt(double time) const {
  const auto place = std::lower_bound(times_.begin(), times_.end(), time);
  return static_cast<std::size_t>(place - times_.begin());
}

SampleRange CommandComparison::commanded() const {
  const std::size_t begin = sampleAt(command_times_.front() + kRunIn);
  return {begin, std::max(begin, sampleAt(command_times_.back()))};
}

SampleRange CommandComparison::before() const {
  return {0, sampleAt(command_times_.front() - kRunIn)};
}

SampleRange CommandComparison::after() const {
  const std::size_t begin = sampleAt(command_times_.back() + kRunIn);
  return {begin, times_.size()};
}

double CommandComparison::unseen() const {
  constexpr std::size_t kPlaces = 200;
  constexpr double kSeldom = 0.2;  // of what each had if all had alike
  const double step = usualStep(command_times_);
  std::vector<double> places(kPlaces, 0.0);
  double count = 0.0;
  std::size_t next = 0;
  for (const double time : times_) {
    while (next < command_times_.size() && command_times_[next] <= time) {
      ++next;
    }
    if (next > 0 && next < command_times_.size()) {
      const double share = (time - command_times_[next - 1]) / step;
      places[static_cast<std::size_t>(share * kPlaces) % kPlaces] += 1.0;
      count += 1.0;
    }
  }
  std::size_t longest = 0;
  std::size_t empty = 0;
  for (std::size_t n = 0; n < 2 * kPlaces; ++n) {
    empty = places[n % kPlaces] < kSeldom * count / kPlaces ? empty + 1 : 0;
    longest = std::max(longest, std::min(empty, kPlaces));
  }
  return step * static_cast<double>(longest) / kPlaces;
}

double CommandComparison::jitter() const {
  const double step = usualStep(command_times_);
  std::vector<double> apart;
  for (std::size_t n = 1; n < command_times_.size(); ++n) {
    apart.push_back(std::abs(command_times_[n] - command_times_[n - 1] - step));
  }
  return apart.empty() ? 0.0 : medianOf(std::move(apart)) / kMedianOfNormal / std::sqrt(2.0);
}

}  // namespace sac
