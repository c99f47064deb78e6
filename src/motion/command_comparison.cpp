#include "command_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "joint_track.hpp"

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

double CommandComparison::lockstep() const {
  std::complex<double> sum = 0.0;
  double count = 0.0;
  std::size_t next = 0;
  for (const double time : times_) {
    while (next < command_times_.size() && command_times_[next] <= time) {
      ++next;
    }
    if (next > 0 && next < command_times_.size()) {
      const double before = command_times_[next - 1];
      sum += std::polar(1.0, 2.0 * M_PI * (time - before) / (command_times_[next] - before));
      count += 1.0;
    }
  }
  return count > 0.0 ? std::abs(sum) / count : 0.0;
}

}  // namespace sac
