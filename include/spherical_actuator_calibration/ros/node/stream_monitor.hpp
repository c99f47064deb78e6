#pragma once

#include <cstddef>
#include <mutex>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/time.h>

namespace sac {

/// What a stream of stamped measurements must keep to.
struct StreamLimits {
  double smallest_rate = 1.0;  ///< [Hz]; a slower stream is a warning
  double largest_age = 0.5;    ///< of the newest measurement [s]; an older one is an error
};

/// Of a stream that should have this rate [Hz]: one slower than half of it is a warning.
StreamLimits limitsOfRate(double rate);

/// Health of one stream for /diagnostics: rate, age of the newest measurement, measurements refused
/// and why. Thread-safe.
class StreamMonitor : public diagnostic_updater::DiagnosticTask {
 public:
  StreamMonitor(const std::string& stream, const StreamLimits& limits);

  /// A measurement that was used, with its acquisition time.
  void accept(const ros::Time& stamp);
  /// A measurement that was not, with the reason in one sentence.
  void refuse(const std::string& reason);

  /// Age of the newest measurement [s]; infinite before the first.
  double age(const ros::Time& now) const;

  /// Called by diagnostic_updater; rates are those since the call before.
  void run(diagnostic_updater::DiagnosticStatusWrapper& status) override;

 private:
  double ageLocked(const ros::Time& now) const;

  const StreamLimits limits_;
  mutable std::mutex mutex_;
  ros::Time newest_;  ///< zero before the first
  std::size_t accepted_ = 0;
  std::size_t refused_ = 0;
  std::string last_refusal_;
  std::size_t accepted_before_ = 0;  ///< at the last run()
  std::size_t refused_before_ = 0;
  ros::WallTime last_run_;
};

}  // namespace sac
