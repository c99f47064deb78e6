#include "joint_track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "spherical_actuator_calibration/base/median.hpp"

namespace sac {

namespace {

template <typename Times>
double medianStep(const Times& times) {
  constexpr std::size_t kEnough = 20000;
  if (times.size() < 2) {
    return 0.0;
  }
  const std::size_t stride = std::max<std::size_t>(1, times.size() / kEnough);
  std::vector<double> steps;
  for (std::size_t n = 0; n + 1 < times.size(); n += stride) {
    steps.push_back(times[n + 1] - times[n]);
  }
  return medianOf(std::move(steps));
}

}  // namespace

double usualStep(const std::vector<double>& times) {
  return medianStep(times);
}

double usualStep(const StampTimes& times) {
  return medianStep(times);
}

double longestWhole(double step, double steps) {
  constexpr double kShort = 5.1e-3;  // [s]
  return std::max(steps * step, kShort);
}

std::vector<double> secondsFrom(Stamp origin, const LongSeries<Stamp>& stamps) {
  std::vector<double> times;
  times.reserve(stamps.size());
  for (const Stamp stamp : stamps) {
    times.push_back(secondsBetween(origin, stamp));
  }
  return times;
}

JointTrack::JointTrack(const MotionStreams& streams, Stamp origin)
    : streams_(&streams), times_(origin, streams.joint_stamps) {
  constexpr double kGap = 2.5;  // steps
  step_ = usualStep(times_);
  longest_ = longestWhole(step_, kGap);
}

std::size_t JointTrack::rateReach() const {
  constexpr double kSpan = 0.01;  // [s]
  return static_cast<std::size_t>(kSpan / (2.0 * step_));
}

std::optional<TrackPoint> JointTrack::begun(double time, std::size_t count) const {
  const std::size_t above = times_.firstAfter(time);
  if (times_.size() < count || above == 0 || above == times_.size()) {
    return std::nullopt;
  }
  TrackPoint point;
  point.first = std::min(above - std::min(above, count / 2), times_.size() - count);
  point.count = count;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    if (!isWhole(point.first + k)) {
      return std::nullopt;
    }
  }
  point.position.setZero();
  point.velocity.setZero();
  return point;
}

std::optional<TrackPoint> JointTrack::smoothAt(double time, double length) const {
  const auto around = static_cast<std::size_t>(std::lround(length / step_));
  const std::size_t count = std::min(kMostShares, around);
  if (count <= kStencil) {
    return at(time);
  }
  std::optional<TrackPoint> point = begun(time, count);
  if (!point) {
    return point;
  }
  // Powers of time, in steps from where it is asked for.
  Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, kMostShares> powers(4, point->count);
  for (std::size_t a = 0; a < point->count; ++a) {
    const double t = (times_[point->first + a] - time) / step_;
    powers.col(static_cast<Eigen::Index>(a)) << 1.0, t, t * t, t * t * t;
  }
  const Eigen::Matrix4d squares = powers * powers.transpose();
  const Eigen::Matrix<double, 4, 2> wanted = Eigen::Matrix<double, 4, 2>::Identity();
  const Eigen::Matrix<double, 4, 2> factors = Eigen::LDLT<Eigen::Matrix4d>(squares).solve(wanted);
  for (std::size_t a = 0; a < point->count; ++a) {
    const Eigen::Vector2d weights = factors.transpose() * powers.col(static_cast<Eigen::Index>(a));
    point->share[a] = weights[0];
    point->position += weights[0] * reading(point->first + a);
    point->velocity += (weights[1] / step_) * reading(point->first + a);
  }
  return point;
}

std::optional<TrackPoint> JointTrack::at(double time) const {
  std::optional<TrackPoint> found = begun(time, kStencil);
  if (!found) {
    return found;
  }
  TrackPoint& point = *found;
  std::array<double, kStencil> times{};
  for (std::size_t a = 0; a < kStencil; ++a) {
    times[a] = times_[point.first + a];
  }
  for (std::size_t a = 0; a < kStencil; ++a) {
    // Lagrange's polynomial of reading a and its derivative.
    double value = 1.0;
    double slope = 0.0;
    for (std::size_t b = 0; b < kStencil; ++b) {
      if (a == b) {
        continue;
      }
      const double width = times[a] - times[b];
      const double factor = (time - times[b]) / width;
      slope = slope * factor + value / width;
      value *= factor;
    }
    point.share[a] = value;
    point.position += value * reading(point.first + a);
    point.velocity += slope * reading(point.first + a);
  }
  return found;
}

}  // namespace sac
