#include "command_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Core>

#include "command_comparison.hpp"
#include "current_steps.hpp"
#include "joint_track.hpp"
#include "response_search.hpp"
#include "spherical_actuator_calibration/base/median.hpp"

namespace sac {
namespace {

/// How all changes of a span agree with those expected.
class Agreement {
 public:
  Agreement(const CommandComparison& comparison, double delay, double lag)
      : followed_(Eigen::ArrayXd::Zero(comparison.coils())),
        common_(followed_),
        left_(followed_),
        earlier_(followed_),
        before_(followed_),
        left_before_(followed_) {
    const auto add_all = [&](const SampleRange& range) {
      comparison.visit(
          delay, lag, range, [this](const Eigen::ArrayXd& change, const Eigen::ArrayXd& expected) {
            add(change, expected);
          });
    };
    add_all(comparison.commanded());
    const double usual = left_.sum() / count_;
    for (const SampleRange& range : {comparison.before(), comparison.after()}) {
      Beside& beside = range.begin == 0 ? before_first_ : after_last_;
      comparison.visit(
          delay, lag, range, [&](const Eigen::ArrayXd& change, const Eigen::ArrayXd& /*none*/) {
            beside.samples += 1.0;
            beside.changes += change.square().sum() > kForeign * usual ? 1.0 : 0.0;
          });
    }
    add_all(comparison.before());
  }

  /// Whether all coils follow: one that does not would act at another time than the others.
  bool isGood() const {
    constexpr double kTolerance = 0.2;
    constexpr double kSure = 3.0;      // standard deviations
    constexpr double kSilent = 1e-12;  // [A²] in all
    constexpr double kMostMisfit = 0.15;
    const double usual = medianOf(std::vector<double>(left_.data(), left_.data() + left_.size()));
    const auto are_missing = [](const Beside& beside) {
      return beside.samples > 0.0 && beside.changes > kTolerance * beside.samples;
    };
    if (!(followed_.sum() > kSilent) || misfit() > kMostMisfit || are_missing(before_first_) ||
        are_missing(after_last_)) {
      return false;
    }
    for (Eigen::Index coil = 0; coil < left_.size(); ++coil) {
      const double uncertainty = kSure * std::sqrt(left_[coil] / count_ * followed_[coil]);
      const bool follows =
          std::abs(common_[coil] - followed_[coil]) <= kTolerance * followed_[coil] + uncertainty;
      if (!follows || left_[coil] > kForeign * usual + kTolerance * followed_[coil]) {
        return false;
      }
    }
    return std::abs(common_.sum() / followed_.sum() - 1.0) < kTolerance;
  }

  /// Of a current, if nothing else makes changes other than expected [A].
  double noise() const {
    return std::sqrt(0.5 * left_.sum() / (count_ * static_cast<double>(left_.size())));
  }

  /// What of changes is not as expected, relative to them: what is left grows with the changes
  /// there, noise does not.
  double misfit() const {
    const double values = count_ * static_cast<double>(left_.size());
    const double changes = changes_ / values;
    const double spread = fourth_ / values - changes * changes;
    const double common = product_ / values - changes * left_.sum() / values;
    return spread > 0.0 ? std::sqrt(std::max(0.0, common / spread)) : 0.0;
  }

 private:
  void add(const Eigen::ArrayXd& change, const Eigen::ArrayXd& expected) {
    const Eigen::ArrayXd square = expected.square();
    const Eigen::ArrayXd left = (change - expected).square();
    followed_ += square;
    common_ += expected * change;
    left_ += left;
    count_ += 1.0;
    // What is late is left beside the change.
    const Eigen::ArrayXd around = earlier_ + before_ + square;
    changes_ += around.sum();
    fourth_ += around.square().sum();
    product_ += (around * left_before_).sum();
    earlier_ = before_;
    before_ = square;
    left_before_ = left;
  }

  /// Before the first command, or after the last: many changes there are of commands that are
  /// missing.
  struct Beside {
    double samples = 0.0;
    double changes = 0.0;  ///< samples at which currents change
  };

  static constexpr double kForeign = 3.0;  ///< times what is left of the others

  Beside before_first_;
  Beside after_last_;
  // Sums over all changes, coil by coil.
  Eigen::ArrayXd followed_;  ///< squares of what is expected
  Eigen::ArrayXd common_;    ///< products with what was measured
  Eigen::ArrayXd left_;      ///< squares of what is left
  double count_ = 0.0;       ///< changes of each coil
  // Squares of the last changes.
  Eigen::ArrayXd earlier_;
  Eigen::ArrayXd before_;
  Eigen::ArrayXd left_before_;
  // Sums over all changes and coils, of three changes in a row that are expected.
  double changes_ = 0.0;
  double fourth_ = 0.0;   ///< squares
  double product_ = 0.0;  ///< with what is left of the middle one
};

/// Puts means in place of what was sampled, sample by sample.
class MeanTaker {
 public:
  explicit MeanTaker(const CommandComparison& comparison)
      : comparison_(comparison), longest_(kGap * usualStep(comparison.times())) {}

  void run(FollowedCommands followed, MotionStreams& streams) {
    const std::vector<double>& times = comparison_.times();
    followed.start(times.front());
    Sample earlier;
    Sample before;
    Sample now{followed.current(), {}, false};
    Eigen::ArrayXd rising = Eigen::ArrayXd::Zero(comparison_.coils());
    HatSums sums;
    for (std::size_t n = 0; n + 1 < times.size(); ++n) {
      followed.advance(times[n + 1], sums);
      const double after = times[n + 1] - times[n];
      const double step = n == 0 ? 0.0 : times[n] - times[n - 1];
      now.has_mean = n > 0 && std::max(step, after) < longest_;
      now.mean = 2.0 / (step + after) * (rising + sums.falling);
      if (earlier.has_mean && before.has_mean && now.has_mean) {
        // The hat makes linear of what weighs the currents, too flat where that bends: a twelfth
        // of the second difference makes up for it.
        const Eigen::ArrayXd bend = earlier.mean - 2.0 * before.mean + now.mean;
        const Eigen::ArrayXd added = before.mean - bend / 12.0 - before.value;
        streams.currents.row(static_cast<Eigen::Index>(n - 1)) +=
            added.matrix().transpose().cast<float>();
      }
      rising = sums.rising;
      earlier = std::move(before);
      before = std::move(now);
      now = {followed.current(), {}, false};
    }
  }

 private:
  static constexpr double kGap = 2.5;  // usual intervals

  /// Of what follows the commands.
  struct Sample {
    Eigen::ArrayXd value;
    Eigen::ArrayXd mean;
    bool has_mean = false;
  };

  const CommandComparison& comparison_;
  double longest_;  ///< interval without a hole [s]
};

/// From 0 where a lag is as long as the time between samples to 1 where it is half of that.
double isOver(double between, double lag) {
  return std::clamp(between / lag - 1.0, 0.0, 1.0);
}

/// Of a delay, by what is not as modelled: commands that come now sooner, now later, lags of higher
/// order. Where currents are always sampled at the same places between two commands, and a lag is
/// over between two of these, nothing shows it; of commands that come at uneven times the step
/// itself is then anywhere there, and the lag seems longer than it is.
double modelStddev(const CommandComparison& comparison, const Agreement& agreement, double lag) {
  constexpr double kPerMisfit = 0.25;
  constexpr double kHidden = 0.09;
  constexpr double kAnywhere = 0.29;  // 1 / √12
  constexpr double kUneven = 0.01;    // of what is unseen
  constexpr double kLonger = 2.0;
  constexpr double kLeast = 3e-6;  // [s]
  const double unseen = comparison.unseen();
  const double jitter = comparison.jitter();
  const double by_misfit = std::max(kLeast, kPerMisfit * agreement.misfit() * lag);
  if (jitter < kUneven * unseen) {
    return std::max(by_misfit, kHidden * unseen * isOver(unseen, lag));
  }
  return std::max({by_misfit,
                   kAnywhere * unseen * isOver(kLonger * unseen, lag),
                   jitter * isOver(usualStep(comparison.times()), lag)});
}

/// Of the delay of currents that count as they were sampled.
double stddevAsSampled(const MotionStreams& streams, double noise) {
  CurrentSteps steps;
  steps.add(streams);
  return steps.delayStddev(noise);
}

}  // namespace

std::optional<CommandResponse> takeMeans(const CommandStream& commands, MotionStreams& streams) {
  constexpr std::size_t kLeast = 100;
  constexpr double kLargestDelay = 0.08;  // [s]
  constexpr double kLargestLag = 0.05;    // [s]
  // What commands tell is measured, what samples tell without them supposed.
  constexpr double kMuchLess = 2.0;
  if (streams.current_stamps.size() < kLeast || commands.stamps.size() < kLeast) {
    return std::nullopt;
  }
  const CommandComparison comparison(streams, commands);
  if (comparison.commanded().count() < kLeast) {
    return std::nullopt;
  }
  ResponseSearch search(comparison);
  search.run();
  const bool is_found = std::isfinite(search.latenessStddev()) &&
                        std::abs(search.delay()) < kLargestDelay && search.lag() < kLargestLag;
  if (!is_found) {
    return std::nullopt;
  }
  const Agreement agreement(comparison, search.delay(), search.lag());
  if (!agreement.isGood()) {
    return std::nullopt;
  }
  CommandResponse response;
  response.delay = search.delay();
  response.lag = search.lag();
  response.lateness_stddev =
      std::hypot(search.latenessStddev(), modelStddev(comparison, agreement, search.lag()));
  if (!(response.lateness_stddev < kMuchLess * stddevAsSampled(streams, agreement.noise()))) {
    return std::nullopt;
  }
  MeanTaker(comparison).run(comparison.follow(search.delay(), search.lag()), streams);
  return response;
}

}  // namespace sac
