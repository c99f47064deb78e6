#include "current_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "joint_track.hpp"
#include "motion_point.hpp"

namespace sac {

void CurrentSteps::add(const MotionStreams& streams) {
  constexpr double kGap = 2.0;  // usual intervals
  if (streams.current_stamps.size() < 3) {
    return;
  }
  if (streams.response) {
    const auto samples = static_cast<double>(streams.current_stamps.size());
    told_ += samples * streams.response->delay_stddev * streams.response->delay_stddev;
    told_samples_ += samples;
    return;
  }
  const auto at = [&](Eigen::Index n) { return streams.currents.row(n).cast<double>(); };
  const std::vector<Stamp>& stamps = streams.current_stamps;
  const auto interval = [&](std::size_t n) { return secondsBetween(stamps[n - 1], stamps[n]); };
  const double longest = kGap * usualStep(StampTimes(stamps.front(), stamps));
  for (std::size_t n = 2; n < stamps.size(); ++n) {
    if (std::max(interval(n), interval(n - 1)) > longest) {
      continue;
    }
    const auto row = static_cast<Eigen::Index>(n);
    changes_ += (at(row) - at(row - 1)).squaredNorm();
    bends_ += (at(row) - 2.0 * at(row - 1) + at(row - 2)).squaredNorm();
    values_ += static_cast<double>(streams.currents.cols());
    duration_ += interval(n);
    intervals_ += 1.0;
  }
}

double CurrentSteps::delayStddev(double noise) const {
  const double samples = told_samples_ + intervals_;
  const double sampled = sampledStddev(noise);
  return samples > 0.0 ? std::sqrt((told_ + intervals_ * sampled * sampled) / samples) : 0.0;
}

double CurrentSteps::sampledStddev(double noise) const {
  // Samples of less show no steps: the currents are smooth, or they step once an interval.
  constexpr double kLeastBend = 0.1;
  if (!(intervals_ > 0.0)) {
    return 0.0;
  }
  const double interval = duration_ / intervals_;
  const double variance = noise * noise * values_;
  const double changes = changes_ - 2.0 * variance;
  const double bends = bends_ - 6.0 * variance;
  if (!(bends > kLeastBend * changes)) {
    return interval / std::sqrt(12.0);
  }
  // What is left of a step one interval later, if all changes are such steps.
  const double left = changes > 0.0 ? std::max(0.0, 1.0 - 0.5 * bends / changes) : 0.0;
  const double decay = left > 0.0 ? -1.0 / std::log(left) : 0.0;
  // Largest where the steps are at the very instants of samples.
  return interval * (1.0 / (1.0 - left) - 0.5 - decay);
}

double CurrentSteps::widen(const ParameterSpace& space,
                           double noise,
                           ParameterBelief& belief) const {
  const Eigen::Index place = MotionPlaces(space).current_delay;
  if (place < 0 || !(belief.covariance(place, place) > 0.0)) {
    return 0.0;
  }
  const double stddev = delayStddev(noise) / space.effects().scale(place - space.effect());
  belief.covariance(place, place) += stddev * stddev;
  return stddev * stddev;
}

}  // namespace sac
