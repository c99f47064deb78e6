#include "spherical_actuator_calibration/ros/node/stream_monitor.hpp"

#include <algorithm>
#include <limits>

#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/time_conversion.hpp"
#include "spherical_actuator_calibration/ros/node/node_diagnostics.hpp"

namespace sac {

StreamLimits limitsOfRate(double rate) {
  constexpr double kLargestAge = 0.5;  // at least [s]
  constexpr double kPeriods = 3.0;
  return {0.5 * rate, std::max(kLargestAge, kPeriods / rate)};
}

StreamMonitor::StreamMonitor(const std::string& stream, const StreamLimits& limits)
    : DiagnosticTask(stream), limits_(limits), last_run_(ros::WallTime::now()) {}

void StreamMonitor::accept(const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_ = stamp;
  ++accepted_;
}

void StreamMonitor::refuse(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_refusal_ = printable(reason);
  ++refused_;
}

double StreamMonitor::age(const ros::Time& now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ageLocked(now);
}

double StreamMonitor::ageLocked(const ros::Time& now) const {
  return newest_.isZero() ? std::numeric_limits<double>::infinity() : secondsBetween(newest_, now);
}

void StreamMonitor::run(DiagnosticStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::WallTime now = ros::WallTime::now();
  const double span = std::max((now - last_run_).toSec(), 1e-3);
  const double rate = static_cast<double>(accepted_ - accepted_before_) / span;
  const std::size_t refused_now = refused_ - refused_before_;
  const double age = ageLocked(ros::Time::now());
  accepted_before_ = accepted_;
  refused_before_ = refused_;
  last_run_ = now;

  if (newest_.isZero()) {
    status.summary(DiagnosticStatus::ERROR, "nothing was received yet");
  } else if (age > limits_.largest_age) {
    status.summaryf(DiagnosticStatus::ERROR, "silent for %.2f s", age);
  } else if (refused_now > 0) {
    status.summary(DiagnosticStatus::WARN, "refused: " + last_refusal_);
  } else if (rate < limits_.smallest_rate) {
    status.summaryf(DiagnosticStatus::WARN, "slow: %.1f Hz", rate);
  } else {
    status.summary(DiagnosticStatus::OK, "good");
  }
  status.addf("rate [Hz]", "%.1f", rate);
  status.addf("age [s]", "%.3f", age);
  status.add("accepted", accepted_);
  status.add("refused", refused_);
  addTextOrNone(status, "last refusal", last_refusal_);
}

}  // namespace sac
