#include "spherical_actuator_calibration/emulation/stream_schedule.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/value_range.hpp"

namespace sac {
namespace {

/// Events lie within the first part of a session, so that measurements follow that show them.
constexpr double kEventShare = 0.95;

/// Random times, one in each of equal parts of the session, latest first.
std::vector<double> eventTimes(std::size_t count, double duration, NoiseSource& noise) {
  const double part = kEventShare * duration / static_cast<double>(count);
  std::vector<double> times;
  for (std::size_t left = count; left > 0; --left) {
    times.push_back(part * (static_cast<double>(left - 1) + noise.share()));
  }
  return times;
}

}  // namespace

void validate(const std::string& stream, const StreamOptions& options) {
  const ValueRange share = ValueRange::closed(0.0, 1.0);
  requireInRange(
      stream + " rate", options.rate, ValueRange{0.0, 1e5, "Hz", /*minimum_excluded=*/true, false});
  requireInRange(stream + " phase", options.phase, ValueRange::nonNegative("s"));
  // Up to half a period stamps stay in order.
  requireInRange(stream + " jitter",
                 options.jitter,
                 ValueRange{0.0, 0.5 / options.rate, "s", false, /*maximum_excluded=*/true});
  requireInRange(
      stream + " dropout duration", options.dropout_duration, ValueRange::nonNegative("s"));
  requireInRange(stream + " share of repeated measurements", options.repeated_share, share);
  requireInRange(stream + " share of NaN", options.nan_share, share);
}

StreamSchedule::StreamSchedule(const StreamOptions& options,
                               double duration,
                               std::uint64_t seed,
                               RandomPurpose purpose)
    : options_(options),
      duration_(duration),
      noise_(seed, purpose),
      dropout_times_(eventTimes(options.dropouts, duration, noise_)),
      glitch_times_(eventTimes(options.glitches, duration, noise_)) {
  advance();
}

bool StreamSchedule::isSilent(double time) {
  while (!dropout_times_.empty() && time >= dropout_times_.back() + options_.dropout_duration) {
    dropout_times_.pop_back();
  }
  return !dropout_times_.empty() && time >= dropout_times_.back();
}

void StreamSchedule::advance() {
  double time = 0.0;
  do {
    // Half a period later than the beat, so that no jitter leads before the begin.
    const double beat = (static_cast<double>(beat_) + 0.5) / options_.rate + options_.phase;
    ++beat_;
    time = beat + noise_.uniform(options_.jitter);
    next_.not_a_number = noise_.share() < options_.nan_share;
    next_.repeated = noise_.share() < options_.repeated_share;
  } while (isSilent(time) && time < duration_);
  done_ = done_ || time >= duration_;
  next_.since_begin = static_cast<Stamp>(std::llround(time / kSecondsPerTick));
  next_.glitch = !glitch_times_.empty() && time >= glitch_times_.back();
  if (next_.glitch) {
    glitch_times_.pop_back();
  }
}

}  // namespace sac
