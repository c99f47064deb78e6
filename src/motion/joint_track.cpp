#include "joint_track.hpp"

#include <algorithm>
#include <utility>

#include "spherical_actuator_calibration/base/median.hpp"

namespace sac {

double usualStep(const std::vector<double>& times) {
  if (times.size() < 2) {
    return 0.0;
  }
  std::vector<double> steps(times.size() - 1);
  for (std::size_t n = 0; n < steps.size(); ++n) {
    steps[n] = times[n + 1] - times[n];
  }
  return medianOf(std::move(steps));
}

std::vector<double> secondsFrom(Stamp origin, const std::vector<Stamp>& stamps) {
  std::vector<double> times;
  times.reserve(stamps.size());
  for (const Stamp stamp : stamps) {
    times.push_back(secondsBetween(origin, stamp));
  }
  return times;
}

JointTrack::JointTrack(const MotionStreams& streams, Stamp origin)
    : streams_(&streams), times_(secondsFrom(origin, streams.joint_stamps)) {
  step_ = usualStep(times_);
}

std::optional<TrackPoint> JointTrack::at(double time) const {
  constexpr std::size_t kStencil = 4;
  const auto above = std::upper_bound(times_.begin(), times_.end(), time);
  if (times_.size() < kStencil || above == times_.begin() || above == times_.end()) {
    return std::nullopt;
  }
  const auto n = static_cast<std::size_t>(above - times_.begin()) - 1;
  TrackPoint point;
  point.first = std::min(n == 0 ? 0 : n - 1, times_.size() - kStencil);
  for (std::size_t k = 0; k + 1 < kStencil; ++k) {
    if (!isWhole(point.first + k)) {
      return std::nullopt;
    }
  }
  point.position.setZero();
  point.velocity.setZero();
  for (std::size_t a = 0; a < kStencil; ++a) {
    // Lagrange's polynomial of reading a and its derivative.
    double value = 1.0;
    double slope = 0.0;
    for (std::size_t b = 0; b < kStencil; ++b) {
      if (a == b) {
        continue;
      }
      const double width = times_[point.first + a] - times_[point.first + b];
      const double factor = (time - times_[point.first + b]) / width;
      slope = slope * factor + value / width;
      value *= factor;
    }
    point.share[a] = value;
    point.position += value * reading(point.first + a);
    point.velocity += slope * reading(point.first + a);
  }
  return point;
}

}  // namespace sac
