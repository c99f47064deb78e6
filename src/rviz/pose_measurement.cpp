#include "pose_measurement.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <utility>

namespace sac {
namespace {

/// The amplifier's own lag, and what the rotor needs to rest [s].
constexpr double kSettling = 0.3;
/// In which coils must carry their current [s].
constexpr double kPatience = 10.0;
/// Before the node is asked again whether they do [s].
constexpr double kPause = 0.1;

}  // namespace

void PoseMeasurement::begin(std::vector<std::uint32_t> patterns, double current, double now) {
  patterns_ = std::move(patterns);
  if (!patterns_.empty() && patterns_.front() != 0) {
    patterns_.insert(patterns_.begin(), 0);
  }
  place_ = 0;
  samples_ = 0;
  current_ = current;
  outcome_.clear();
  if (patterns_.size() > 1 && !(std::abs(current) >= least_)) {
    char text[96];
    std::snprintf(text,
                  sizeof(text),
                  "%.3g A are too little to tell a coil from one that is off: take %.3g A or more.",
                  std::fabs(current),
                  least_);
    end(text);
    return;
  }
  beginPattern(now);
}

void PoseMeasurement::beginPattern(double now) {
  began_ = now;
  next_ = now + kSettling;
  is_asked_ = false;
}

PoseMeasurement::Action PoseMeasurement::step(double now) {
  if (!isRunning()) {
    return Action::kEnd;
  }
  if (is_asked_ || now < next_) {
    return Action::kNothing;
  }
  is_asked_ = true;
  return Action::kCapture;
}

void PoseMeasurement::captured(const CaptureOutcome& outcome, double now) {
  if (!isRunning() || !is_asked_) {
    return;
  }
  if (outcome.flaw == CaptureOutcome::Flaw::kExcitation && now - began_ <= kPatience) {
    next_ = now + kPause;
    is_asked_ = false;
  } else if (outcome.flaw == CaptureOutcome::Flaw::kRestInterrupted) {
    patterns_.insert(patterns_.begin() + static_cast<std::ptrdiff_t>(place_), 0);
    beginPattern(now);
  } else if (!outcome.success) {
    end(outcome.message);
  } else {
    ++samples_;
    advance(now);
  }
}

void PoseMeasurement::advance(double now) {
  ++place_;
  if (isRunning()) {
    beginPattern(now);
    return;
  }
  outcome_ = "The pose is measured: " + std::to_string(samples_) +
             (samples_ == 1 ? " sample." : " samples.");
}

void PoseMeasurement::end(const std::string& reason) {
  patterns_.clear();
  place_ = 0;
  outcome_ = reason;
}

}  // namespace sac
