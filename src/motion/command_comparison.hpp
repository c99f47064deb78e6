#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "followed_commands.hpp"

namespace sac {

/// From `begin` to before `end`.
struct SampleRange {
  std::size_t begin = 0;
  std::size_t end = 0;

  std::size_t count() const { return end - begin; }
};

/// Measured currents of a span and what follows the commands, by one clock.
class CommandComparison {
 public:
  /// Keeps references. Precondition: there are currents and commands.
  CommandComparison(const MotionStreams& streams, const CommandStream& commands);

  /// Of the currents, from the first one [s].
  const std::vector<double>& times() const { return times_; }
  Eigen::Index coils() const { return streams_.currents.cols(); }
  Eigen::ArrayXd measured(std::size_t n) const {
    return streams_.currents.row(static_cast<Eigen::Index>(n)).transpose().cast<double>();
  }
  FollowedCommands follow(double delay, double lag) const {
    return {command_times_, commands_.currents, delay, lag};
  }
  /// Samples while there are commands, without those at the begin that have what was before.
  SampleRange commanded() const;
  /// Those before the first command.
  SampleRange before() const;
  /// Those after what the last command does.
  SampleRange after() const;

  /// The longest time between two commands at which currents are hardly ever sampled: where they
  /// are always sampled at the same places that between two of these [s].
  double unseen() const;
  /// By how much commands come sooner or later than at even steps, as a standard deviation [s].
  double jitter() const;

  /// Tells a visitor the changes from sample to sample, as measured and as expected, from one
  /// of a range to the next.
  template <typename Visitor>
  void visit(double delay, double lag, const SampleRange& range, const Visitor& visitor) const {
    if (range.count() == 0) {
      return;
    }
    FollowedCommands followed = follow(delay, lag);
    followed.start(times_[range.begin] - kRunIn);
    Eigen::ArrayXd before;
    Eigen::ArrayXd followed_before;
    for (std::size_t n = range.begin; n < range.end; ++n) {
      followed.advance(times_[n]);
      const Eigen::ArrayXd now = measured(n);
      if (n > range.begin) {
        visitor(now - before, followed.current() - followed_before);
      }
      before = now;
      followed_before = followed.current();
    }
  }

 private:
  static constexpr double kRunIn = 0.15;  ///< for what was before to be forgotten [s]

  std::size_t sampleAt(double time) const;

  const MotionStreams& streams_;
  const CommandStream& commands_;
  std::vector<double> times_;
  std::vector<double> command_times_;
};

}  // namespace sac
