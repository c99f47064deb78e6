#include "pose_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <utility>

#include "spherical_actuator_calibration/base/numbering.hpp"

namespace sac {
namespace {

/// The amplifier's own lag, and what the rotor needs to rest [s].
constexpr double kSettling = 0.3;
/// In which coils must carry their current [s].
constexpr double kPatience = 10.0;

}  // namespace

bool CurrentRule::allows(double measured, double commanded) const {
  return std::abs(measured - commanded) <= std::max(tolerance, share * std::abs(commanded));
}

void PoseMeasurement::begin(std::vector<std::uint32_t> patterns, double current, double now) {
  patterns_ = std::move(patterns);
  if (!patterns_.empty() && patterns_.front() != 0) {
    patterns_.insert(patterns_.begin(), 0);
  }
  place_ = 0;
  samples_ = 0;
  current_ = current;
  outcome_.clear();
  if (patterns_.size() > 1 && !(std::abs(current) >= rule_.least)) {
    char text[96];
    std::snprintf(text,
                  sizeof(text),
                  "%.3g A are too little to tell a coil from one that is off: take %.3g A or more.",
                  std::fabs(current),
                  rule_.least);
    end(text);
    return;
  }
  beginPattern(now);
}

void PoseMeasurement::beginPattern(double now) {
  began_ = now;
  settled_ = -1.0;
  is_asked_ = false;
}

PoseMeasurement::Action PoseMeasurement::step(const std::vector<double>& measured, double now) {
  if (!isRunning()) {
    return Action::kEnd;
  }
  if (is_asked_) {
    return Action::kNothing;
  }
  if (!carries(measured)) {
    settled_ = -1.0;
    if (now - began_ > kPatience) {
      end(coil() == 0 ? "The coils do not become free of current: look at the coil driver."
                      : "Coil " + std::to_string(coil()) +
                            " does not carry its current: look at the coil driver.");
      return Action::kEnd;
    }
    return Action::kNothing;
  }
  settled_ = settled_ < 0.0 ? now : settled_;
  if (now - settled_ < kSettling) {
    return Action::kNothing;
  }
  is_asked_ = true;
  return Action::kCapture;
}

void PoseMeasurement::captured(const CaptureOutcome& outcome, double now) {
  if (!isRunning() || !is_asked_) {
    return;
  }
  if (outcome.rest_interrupted) {
    patterns_.insert(patterns_.begin() + static_cast<std::ptrdiff_t>(place_), 0);
    beginPattern(now);
    return;
  }
  if (!outcome.success) {
    end(outcome.message);
    return;
  }
  ++samples_;
  advance(now);
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

bool PoseMeasurement::carries(const std::vector<double>& measured) const {
  for (std::size_t j = 0; j < measured.size(); ++j) {
    const double wanted = numberOf(j) == coil() ? current() : 0.0;
    if (!rule_.allows(measured[j], wanted)) {
      return false;
    }
  }
  return !measured.empty() && coil() <= measured.size();
}

}  // namespace sac
