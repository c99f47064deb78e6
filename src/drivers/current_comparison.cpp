#include "spherical_actuator_calibration/drivers/current_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sac {
namespace {

/// Of the amplifiers that are held against the measurement [s].
constexpr std::array<double, 3> kTimeConstants{0.0, 0.015, 0.03};
constexpr auto kFilters = static_cast<Eigen::Index>(kTimeConstants.size());

/// Each delay stands for all up to the next one [s].
constexpr double kDelayStep = 0.01;
constexpr Eigen::Index kDelays = 17;
constexpr double kLongestDelay = kDelayStep * static_cast<double>(kDelays);

/// After the output stages were on again current may be less than what is set: for the longest
/// delay, and until the slowest amplifier is near it [s].
constexpr double kOffForLong = kLongestDelay + 0.06;

/// Of spans of time, however fast or slow the loop is [s].
constexpr double kSpan = 0.5 * kDelayStep;

/// Time constants lie between those that are tried: so much of what the setpoints change is allowed
/// beside the tolerance.
constexpr double kShareOfChange = 0.03;

/// What a beat that agrees takes back, of one that deviates.
constexpr double kForgiven = 0.125;

/// Of a beat, as beats are a little early or late: so many whole ones are as many all the same. And
/// between a measurement that agrees and a long beat that does not, half of that beat did not.
constexpr double kRounding = 0.5;

/// However long a beat took: a single measurement must not decide, nor two.
constexpr double kLargestShare = 0.34;

/// Of the beats that are an error, or so long before there is one [s], whichever is later: from
/// here on it is likely.
constexpr double kSuspicious = 0.5;
constexpr double kForesight = 0.1;

/// Counts go on above their limit, so that all lags can be above it at the same time.
constexpr double kHighestCount = 1.5;

/// What is left of a current after so long [s].
double shareLeft(Eigen::Index filter, double elapsed) {
  const double time_constant = kTimeConstants[static_cast<std::size_t>(filter)];
  if (elapsed <= 0.0) {
    return 1.0;
  }
  return time_constant > 0.0 ? std::exp(-elapsed / time_constant) : 0.0;
}

}  // namespace

CurrentComparison::CurrentComparison(std::size_t coils, double tolerance, int beats, double period)
    : tolerance_(tolerance),
      beats_(beats),
      period_(period),
      setpoints_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils))),
      lowest_(setpoints_),
      highest_(setpoints_),
      lower_(Eigen::ArrayXXd::Zero(setpoints_.size(), kFilters)),
      upper_(lower_),
      deviating_(Eigen::ArrayXXd::Zero(setpoints_.size(), kFilters * kDelays)) {}

void CurrentComparison::setting(const Eigen::VectorXd& setpoints, bool stages_on) {
  setpoints_ = setpoints;
  is_off_ = !stages_on;
  was_off_ = was_off_ || is_off_;
  lowest_ = lowest_.min(setpoints.array());
  highest_ = highest_.max(setpoints.array());
}

std::optional<std::size_t> CurrentComparison::observe(const Eigen::VectorXd& measured,
                                                      double begin,
                                                      double end) {
  const double weight = weightOf(end);
  if (!last_) {
    beginWith(measured.array());
  } else {
    widenBeginning(measured.array());
  }
  off_at_ = was_off_ ? end : off_at_;
  was_off_ = is_off_;
  // What was set before may be in force until the answer to what was set last has come.
  advance(begin);
  lowest_ = highest_ = setpoints_.array();
  advance(end);
  while (spans_.front().end < begin - kLongestDelay) {
    spans_.pop_front();
  }
  count(measured.array(), begin, end, weight);
  Eigen::Index coil = 0;
  most_ = deviating_.rowwise().minCoeff().maxCoeff(&coil);
  if (most_ < beats_ - kRounding * std::max(weight, 1.0)) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(coil);
}

double CurrentComparison::weightOf(double end) const {
  if (!last_) {
    return 1.0;
  }
  // One that was begun early, by a command, is a part of a beat.
  const double beats = (end - *last_) / period_;
  return std::min(beats, std::max(1.0, kLargestShare * beats_));
}

bool CurrentComparison::isSuspicious() const {
  const double enough = std::max(kSuspicious * beats_, beats_ - kForesight / period_);
  return most_ >= enough - kRounding;
}

void CurrentComparison::forgive() {
  deviating_.setZero();
  most_ = 0.0;
}

void CurrentComparison::beginWith(const Eigen::ArrayXd& measured) {
  lowest_ = lowest_.min(measured);
  highest_ = highest_.max(measured);
  lower_.colwise() = lowest_;
  upper_.colwise() = highest_;
}

// Orders from before the driver began may still be on their way: an amplifier whose output stages
// were off, or whose watchdog had acted, follows them when it is switched on.
void CurrentComparison::widenBeginning(const Eigen::ArrayXd& measured) {
  const Span before = spans_.front();
  const bool is_first = std::isinf(before.begin);
  if (!is_first || *last_ - before.end > kLongestDelay) {
    return;
  }
  const Eigen::ArrayXd below = (measured - before.lowest.col(0)).min(0.0);
  const Eigen::ArrayXd above = (measured - before.highest.col(0)).max(0.0);
  for (Eigen::Index filter = 0; filter < kFilters; ++filter) {
    for (Span& span : spans_) {
      const double share = shareLeft(filter, span.begin - before.end);
      span.lowest.col(filter) += share * below;
      span.highest.col(filter) += share * above;
    }
    const double share = shareLeft(filter, *last_ - before.end);
    lower_.col(filter) += share * below;
    upper_.col(filter) += share * above;
  }
}

// Anything between the lowest and the highest setpoint may be in force all the time: no amplifier
// of a time constant leaves what those two make of it. What a delay does not reach back to is one
// span.
void CurrentComparison::advance(double until) {
  if (!last_) {
    remember(settled(-std::numeric_limits<double>::infinity(), until, 0.0));
    last_ = until;
    return;
  }
  until = std::max(until, *last_);
  const double remembered = until - kLongestDelay - kDelayStep;
  do {
    const double to = std::min(until, std::max(*last_ + kSpan, remembered));
    remember(settled(*last_, to, to - *last_));
    last_ = to;
  } while (*last_ < until);
}

CurrentComparison::Span CurrentComparison::settled(double from, double to, double elapsed) {
  Span span{from, to, lower_, upper_};
  for (Eigen::Index filter = 1; filter < kFilters; ++filter) {
    const double share = -std::expm1(-elapsed / kTimeConstants[static_cast<std::size_t>(filter)]);
    lower_.col(filter) += share * (lowest_ - lower_.col(filter));
    upper_.col(filter) += share * (highest_ - upper_.col(filter));
  }
  lower_.col(0) = lowest_;
  upper_.col(0) = highest_;
  span.lowest = span.lowest.min(lower_);
  span.highest = span.highest.max(upper_);
  return span;
}

void CurrentComparison::remember(const Span& span) {
  if (!spans_.empty() && span.end - spans_.back().begin < kSpan) {
    Span& last = spans_.back();
    last.end = span.end;
    last.lowest = last.lowest.min(span.lowest);
    last.highest = last.highest.max(span.highest);
  } else {
    spans_.push_back(span);
  }
}

Eigen::ArrayXd CurrentComparison::tolerances() const {
  Eigen::ArrayXd lowest = spans_.front().lowest.col(0);
  Eigen::ArrayXd highest = spans_.front().highest.col(0);
  for (const Span& span : spans_) {
    lowest = lowest.min(span.lowest.col(0));
    highest = highest.max(span.highest.col(0));
  }
  return tolerance_ + kShareOfChange * (highest - lowest);
}

void CurrentComparison::count(const Eigen::ArrayXd& measured,
                              double begin,
                              double end,
                              double weight) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Eigen::ArrayXd tolerance = tolerances();
  const bool may_be_off = begin - off_at_ <= kOffForLong;
  for (Eigen::Index delay = 0; delay < kDelays; ++delay) {
    const double latest = end - kDelayStep * static_cast<double>(delay);
    const double earliest = begin - kDelayStep * static_cast<double>(delay + 1);
    Eigen::ArrayXXd lowest = Eigen::ArrayXXd::Constant(measured.size(), kFilters, kNone);
    Eigen::ArrayXXd highest = -lowest;
    for (const Span& span : spans_) {
      const bool has_begun = span.begin < latest || delay == 0;
      if (has_begun && span.end > earliest) {
        lowest = lowest.min(span.lowest);
        highest = highest.max(span.highest);
      }
    }
    if (may_be_off) {
      lowest = lowest.min(0.0);
      highest = highest.max(0.0);
    }
    for (Eigen::Index filter = 0; filter < kFilters; ++filter) {
      const auto deviates =
          measured < lowest.col(filter) - tolerance || measured > highest.col(filter) + tolerance;
      auto beats = deviating_.col(kFilters * delay + filter);
      beats = deviates.select((beats + weight).min(kHighestCount * beats_),
                              (beats - kForgiven * weight).max(0.0).eval());
    }
  }
}

}  // namespace sac
