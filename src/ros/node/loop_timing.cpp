#include "spherical_actuator_calibration/ros/node/loop_timing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"
#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

namespace sac {

void LoopTiming::add(const LoopTurn& turn) {
  ++turns_;
  ++sums_.turns;
  const double duration = turn.end - turn.begin;
  sums_.duration += duration;
  largest_.longest_duration = std::max(largest_.longest_duration, duration);
  if (turn.age) {
    noteAge(*turn.age, turn.interval);
  }
  if (last_begin_) {
    const double period = turn.begin - *last_begin_;
    ++sums_.periods;
    sums_.period += period;
    sums_.period_square += period * period;
    largest_.longest_period = std::max(largest_.longest_period, period);
  }
  last_begin_ = turn.begin;
}

// A sensor that was late makes up for it by a short interval: the usual one tells when the next
// reading is due.
void LoopTiming::noteAge(double age, double interval) {
  constexpr double kShare = 0.02;
  ++sums_.ages;
  sums_.age += age;
  largest_.largest_age = std::max(largest_.largest_age, age);
  if (interval > 0.0) {
    usual_interval_ =
        usual_interval_ ? *usual_interval_ + kShare * (interval - *usual_interval_) : interval;
  }
  if (usual_interval_ && age > *usual_interval_) {
    ++old_turns_;
  }
}

TimingReport LoopTiming::take() {
  TimingReport report = largest_;
  report.turns = sums_.turns;
  if (sums_.turns > 0) {
    report.mean_duration = sums_.duration / static_cast<double>(sums_.turns);
  }
  if (sums_.ages > 0) {
    report.mean_age = sums_.age / static_cast<double>(sums_.ages);
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

void addTiming(DiagnosticStatus& status,
               const TimingReport& report,
               const std::string& what,
               const std::string& work) {
  constexpr double kMicro = 1e6;
  status.add("rate [Hz]", report.rate);
  status.add("jitter of the period [us]", kMicro * report.jitter);
  status.add("longest period [us]", kMicro * report.longest_period);
  status.add("mean age of the " + what + " [us]", kMicro * report.mean_age);
  status.add("largest age of the " + what + " [us]", kMicro * report.largest_age);
  status.add("mean " + work + " [us]", kMicro * report.mean_duration);
  status.add("longest " + work + " [us]", kMicro * report.longest_duration);
  status.add("scheduled", describeScheduling());
}

TimingDiagnostics::TimingDiagnostics(std::string turns, std::string what, std::string work)
    : DiagnosticTask("timing"),
      turns_(std::move(turns)),
      what_(std::move(what)),
      work_(std::move(work)) {}

void TimingDiagnostics::add(const LoopTurn& turn) {
  const std::lock_guard<std::mutex> lock(mutex_);
  timing_.add(turn);
}

void TimingDiagnostics::interrupt() {
  const std::lock_guard<std::mutex> lock(mutex_);
  timing_.interrupt();
}

void TimingDiagnostics::run(DiagnosticStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const TimingReport report = timing_.take();
  status.summary(DiagnosticStatus::OK, report.turns > 0 ? "measured" : "no " + turns_);
  status.add(turns_, report.turns);
  addTiming(status, report, what_, work_);
}

}  // namespace sac
