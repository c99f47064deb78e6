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

/// Spans of time are no shorter, however fast the loop is [s].
constexpr double kShortestSpan = 0.5 * kDelayStep;

/// Time constants lie between those that are tried: so much of what the setpoints change is allowed
/// beside the tolerance.
constexpr double kShareOfChange = 0.03;

/// What a beat that agrees takes back, of one that deviates.
constexpr double kForgiven = 0.125;

/// However long a beat took: a single measurement must not decide, nor two.
constexpr double kLargestShare = 0.34;

/// Of the beats that are an error, or so long before there is one [s], whichever is later: from
/// here on it is likely.
constexpr double kSuspicious = 0.5;
constexpr double kForesight = 0.1;

/// Counts go on above their limit, so that all lags can be above it at the same time.
constexpr double kHighestCount = 1.5;

}  // namespace

CurrentComparison::CurrentComparison(std::size_t coils, double tolerance, int beats, double period)
    : tolerance_(tolerance),
      beats_(beats),
      period_(period),
      setpoints_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils))),
      lowest_(setpoints_),
      highest_(setpoints_),
      filtered_(Eigen::ArrayXXd::Zero(setpoints_.size(), kFilters)),
      deviating_(Eigen::ArrayXXd::Zero(setpoints_.size(), kFilters * kDelays)) {}

void CurrentComparison::setting(const Eigen::VectorXd& setpoints) {
  setpoints_ = setpoints;
  lowest_ = lowest_.min(setpoints.array());
  highest_ = highest_.max(setpoints.array());
}

std::optional<std::size_t> CurrentComparison::observe(const Eigen::VectorXd& measured,
                                                      double steady) {
  const double weight = weightOf(steady);
  advance(steady);
  count(measured.array(), steady, weight);
  Eigen::Index coil = 0;
  most_ = deviating_.rowwise().minCoeff().maxCoeff(&coil);
  if (most_ < beats_) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(coil);
}

double CurrentComparison::weightOf(double steady) const {
  const double beats = (steady - last_.value_or(steady)) / period_;
  return std::max(1.0, std::min(beats, kLargestShare * beats_));
}

bool CurrentComparison::isSuspicious() const {
  return most_ >= std::max(kSuspicious * beats_, beats_ - kForesight / period_);
}

void CurrentComparison::forgive() {
  deviating_.setZero();
  most_ = 0.0;
}

// A late beat, or a current that needs a moment: what was set before may still flow. So what was in
// force since the last measurement is all that was set from that one's setpoints on.
void CurrentComparison::advance(double steady) {
  Span span{last_.value_or(-std::numeric_limits<double>::infinity()), steady, filtered_, filtered_};
  const double elapsed = steady - last_.value_or(steady);
  for (Eigen::Index filter = 1; filter < kFilters; ++filter) {
    const double share = -std::expm1(-elapsed / kTimeConstants[static_cast<std::size_t>(filter)]);
    filtered_.col(filter) += share * (filtered_.col(0) - filtered_.col(filter));
  }
  filtered_.col(0) = setpoints_.array();
  span.lowest = span.lowest.min(filtered_);
  span.highest = span.highest.max(filtered_);
  span.lowest.col(0) = span.lowest.col(0).min(lowest_);
  span.highest.col(0) = span.highest.col(0).max(highest_);
  lowest_ = highest_ = setpoints_.array();
  last_ = steady;
  remember(span);
}

void CurrentComparison::remember(const Span& span) {
  if (!spans_.empty() && span.end - spans_.back().begin < kShortestSpan) {
    Span& last = spans_.back();
    last.end = span.end;
    last.lowest = last.lowest.min(span.lowest);
    last.highest = last.highest.max(span.highest);
  } else {
    spans_.push_back(span);
  }
  while (spans_.front().end < span.end - kLongestDelay) {
    spans_.pop_front();
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

void CurrentComparison::count(const Eigen::ArrayXd& measured, double steady, double weight) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Eigen::ArrayXd tolerance = tolerances();
  for (Eigen::Index delay = 0; delay < kDelays; ++delay) {
    const double latest = steady - kDelayStep * static_cast<double>(delay);
    Eigen::ArrayXXd lowest = Eigen::ArrayXXd::Constant(measured.size(), kFilters, kNone);
    Eigen::ArrayXXd highest = -lowest;
    for (const Span& span : spans_) {
      const bool has_begun = span.begin < latest || delay == 0;
      if (has_begun && span.end > latest - kDelayStep) {
        lowest = lowest.min(span.lowest);
        highest = highest.max(span.highest);
      }
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
