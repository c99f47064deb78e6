#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// When an emulated stream delivers, and what goes wrong on the way.
struct StreamOptions {
  double rate = 100.0;            ///< [Hz]
  double phase = 0.0;             ///< delay of the beat [s]
  double jitter = 0.0;            ///< stamps lie uniform within ± this around the beat [s]
  std::size_t dropouts = 0;       ///< spans of silence, spread at random
  double dropout_duration = 0.5;  ///< of each [s]
  std::size_t glitches = 0;       ///< single measurements that are far off, spread at random
  double repeated_share = 0.0;    ///< measurements that are delivered twice
  double nan_share = 0.0;         ///< measurements with a component that is not a number
};

/// Throws ConfigError that names stream and option, the value and the allowed range.
void validate(const std::string& stream, const StreamOptions& options);

/// One measurement to come.
struct ScheduledMeasurement {
  Stamp since_begin = 0;  ///< from the begin of the session
  bool glitch = false;
  bool not_a_number = false;
  bool repeated = false;
};

/// The measurements of one emulated stream, in the order of their strictly growing stamps.
class StreamSchedule {
 public:
  /// `duration`: of the session [s]. Seed and purpose decide everything random.
  StreamSchedule(const StreamOptions& options,
                 double duration,
                 std::uint64_t seed,
                 RandomPurpose purpose);

  /// True when no measurement is left.
  bool done() const { return done_; }
  /// The next measurement, unless done().
  const ScheduledMeasurement& next() const { return next_; }
  /// On to the one after it.
  void advance();
  /// Leaves out everything that is left.
  void stop() { done_ = true; }

 private:
  bool isSilent(double time);

  StreamOptions options_;
  double duration_;
  NoiseSource noise_;
  std::vector<double> dropout_times_;  ///< begins, latest first
  std::vector<double> glitch_times_;   ///< latest first
  std::uint64_t beat_ = 0;
  ScheduledMeasurement next_;
  bool done_ = false;
};

}  // namespace sac
