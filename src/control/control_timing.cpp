#include "spherical_actuator_calibration/control/control_timing.hpp"

#include <algorithm>
#include <cmath>

namespace sac {

void ControlTiming::add(const CommandTime& command) {
  ++commands_;
  ++sums_.commands;
  const double computation = command.end - command.begin;
  sums_.computation += computation;
  largest_.longest_computation = std::max(largest_.longest_computation, computation);
  sums_.age += command.reading_age;
  largest_.largest_age = std::max(largest_.largest_age, command.reading_age);
  noteReading(command.reading_age, command.reading_interval);
  if (last_begin_) {
    const double period = command.begin - *last_begin_;
    ++sums_.periods;
    sums_.period += period;
    sums_.period_square += period * period;
    largest_.longest_period = std::max(largest_.longest_period, period);
  }
  last_begin_ = command.begin;
}

// A sensor that was late makes up for it by a short interval: the usual one tells when the next
// reading is due.
void ControlTiming::noteReading(double age, double interval) {
  constexpr double kShare = 0.02;
  if (interval > 0.0) {
    usual_interval_ =
        usual_interval_ ? *usual_interval_ + kShare * (interval - *usual_interval_) : interval;
  }
  if (usual_interval_ && age > *usual_interval_) {
    ++old_readings_;
  }
}

TimingReport ControlTiming::take() {
  TimingReport report = largest_;
  report.commands = sums_.commands;
  if (sums_.commands > 0) {
    report.mean_age = sums_.age / static_cast<double>(sums_.commands);
    report.mean_computation = sums_.computation / static_cast<double>(sums_.commands);
  }
  if (sums_.period > 0.0) {
    const auto periods = static_cast<double>(sums_.periods);
    const double mean = sums_.period / periods;
    report.rate = 1.0 / mean;
    report.jitter = std::sqrt(std::max(0.0, sums_.period_square / periods - mean * mean));
  }
  sums_ = {};
  largest_ = {};
  return report;
}

}  // namespace sac
