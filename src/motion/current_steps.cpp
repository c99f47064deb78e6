#include "current_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "joint_track.hpp"
#include "motion_point.hpp"

namespace sac {
namespace {

/// Whether samples in a row follow single steps: they bend there, and between two steps some hardly
/// change. What steps once an interval is smooth or, where a sample now and then has one step more
/// or fewer than others, rough in nearly all of them.
class Stretch {
 public:
  /// `change`: from a sample to the next. `before`: the one before that.
  void add(const Eigen::RowVectorXd& change, const Eigen::RowVectorXd& before) {
    const double square = change.squaredNorm();
    changes_ += square;
    fourth_ += square * square;
    bends_ += (change - before).squaredNorm();
    ++samples_;
  }
  bool isFull() const { return samples_ == kSamples; }
  bool showsSteps() const {
    constexpr double kLeastBend = 0.25;
    constexpr double kMostLarge = 0.65;  // of the samples
    return bends_ > kLeastBend * changes_ && changes_ * changes_ < kMostLarge * kSamples * fourth_;
  }

 private:
  static constexpr int kSamples = 20;  ///< in which currents change much alike

  int samples_ = 0;
  // Sums over them.
  double changes_ = 0.0;  ///< squared
  double fourth_ = 0.0;
  double bends_ = 0.0;
};

/// Visits each change from a sample to the next with the time that it took [s]; `pass` says that
/// there is a gap instead.
template <typename Visit, typename Pass>
void eachChange(const MotionStreams& streams, const Visit& visit, const Pass& pass) {
  constexpr double kGap = 2.0;  // usual intervals
  const LongSeries<Stamp>& stamps = streams.current_stamps;
  const double longest = kGap * usualStep(StampTimes(stamps.front(), stamps));
  Eigen::RowVectorXd change;
  for (std::size_t n = 1; n < stamps.size(); ++n) {
    const double interval = secondsBetween(stamps[n - 1], stamps[n]);
    if (interval > longest) {
      pass();
      continue;
    }
    const auto row = static_cast<Eigen::Index>(n);
    change = (streams.currents.row(row) - streams.currents.row(row - 1)).cast<double>();
    visit(change, interval);
  }
}

}  // namespace

void CurrentSteps::add(const MotionStreams& streams) {
  if (streams.current_stamps.size() < 3) {
    return;
  }
  if (streams.response) {
    double slopes = 0.0;
    eachChange(
        streams,
        [&](const Eigen::RowVectorXd& change, double interval) {
          slopes += change.squaredNorm() / interval;
        },
        [] {});
    told_slopes_ += slopes;
    told_ += slopes * streams.response->lateness_stddev;
    return;
  }
  addSampled(streams);
}

void CurrentSteps::addSampled(const MotionStreams& streams) {
  Stretch stretch;
  Eigen::RowVectorXd before;
  Eigen::RowVectorXd before_that;
  const auto take = [&](const Eigen::RowVectorXd& change, double interval) {
    if (before_that.size() > 0) {
      stretch.add(change, before);
      changes_ += change.squaredNorm();
      slopes_ += change.squaredNorm() / interval;
      per_time_ += static_cast<double>(change.size()) / interval;
      next_ += change.dot(before);
      second_ += change.dot(before_that);
      values_ += static_cast<double>(change.size());
      duration_ += interval;
      intervals_ += 1.0;
    }
    if (stretch.isFull()) {
      stretches_ += 1.0;
      stepping_ += stretch.showsSteps() ? 1.0 : 0.0;
      stretch = {};
    }
    before_that.swap(before);
    before = change;
  };
  eachChange(streams, take, [&] {
    before.resize(0);
    before_that.resize(0);
  });
}

// What currents tell of their delay grows with ∫(dI/dt)² dt: by that the estimate is a mean of what
// each span alone would give, and at most as far off as the mean of their deviations.
double CurrentSteps::delayStddev(double noise) const {
  const double sampled = sampledStddev(noise);
  // Noise is in the changes of samples, and not in currents that commands tell.
  const double of_samples = std::max(0.0, slopes_ - 2.0 * noise * noise * per_time_);
  const double slopes = told_slopes_ + of_samples;
  return slopes > 0.0 ? (told_ + of_samples * sampled) / slopes : sampled;
}

double CurrentSteps::sampledStddev(double noise) const {
  if (!(intervals_ > 0.0)) {
    return 0.0;
  }
  const double interval = duration_ / intervals_;
  if (!(stepping_ > 0.5 * stretches_)) {
    return interval / std::sqrt(12.0);
  }
  // Noise is in two changes in a row with either sign.
  const double variance = noise * noise * values_;
  const double changes = changes_ - 2.0 * variance;
  const double next = next_ + variance;
  // What is left of a step one interval later, if all changes are such steps: the first of them is
  // cut by the sample before the step, later ones are not.
  constexpr double kMostLeft = 0.95;
  const bool is_told = changes > 0.0 && next > 0.0;
  const double most = is_told ? std::min(next / changes, kMostLeft) : 0.0;
  const double left = is_told ? std::clamp(second_ / next, 0.0, most) : 0.0;
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
