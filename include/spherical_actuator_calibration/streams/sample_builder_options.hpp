#pragma once

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What is done about the torque that acts without current (sensor bias, unbalanced rotor).
enum class BiasRemoval {
  kNone,         ///< samples carry the raw mean torque
  kZeroCurrent,  ///< the zero-current part of the same dwell is subtracted
};

/// How streams of measurements become samples. Durations in seconds; every duration is measured
/// between stamps, never by a clock.
struct SampleBuilderOptions {
  // Rest: read from the joint sensors alone.
  double rest_window = 0.3;            ///< rest is told over this span [s]
  double largest_joint_spread = 2e-3;  ///< of each joint within the window, max − min [rad]
  /// Largest difference between the means of the thirds of a segment, per joint, beyond what noise
  /// explains [rad]. A slow drift passes the window; here it ends.
  double largest_joint_drift = 2e-4;
  /// The same for the measured orientation [rad]: the tracker saw the rotor move while the joint
  /// sensors stood still. It also bounds the standard deviation of swaying, which neighbouring
  /// measurements share, and a tenth of that of a single measurement.
  double largest_orientation_motion = 5e-3;
  double settle_after_motion = 0.2;  ///< left out at the begin of a dwell [s]
  double guard_before_motion = 0.2;  ///< left out at the end of a dwell [s]
  double largest_dwell = 120.0;      ///< a longer one is cut, so that memory stays bounded [s]

  // Current patterns within a dwell.
  /// A coil below it counts as not excited [A].
  double current_threshold = kExcitationThreshold;
  double current_tolerance = 0.02;           ///< a pattern is constant within ± this, per coil [A]
  double settle_after_current_change = 0.1;  ///< left out at the begin of a segment [s]
  double guard_before_current_change = 0.02;  ///< left out at the end of a segment [s]
  BiasRemoval bias_removal = BiasRemoval::kZeroCurrent;

  // What a mean needs.
  double smallest_duration = 0.2;    ///< of a segment, after settling and guards [s]
  int smallest_count = 10;           ///< measurements of a stream that enter its mean
  double outlier_factor = 6.0;       ///< a glitch is further from the median, × robust stddev
  double joint_stddev_floor = 2e-5;  ///< added in quadrature to the stddev of the mean [rad]
  double orientation_stddev_floor = 2e-5;  ///< the same [rad]
  double torque_stddev_floor = 1e-5;       ///< the same [N·m]

  // Defects of streams.
  /// A longer hole in the joint stream ends the dwell, one in the currents ends the segment; holes
  /// in the other streams are told [s].
  double largest_gap = 0.25;
  /// A stream that is this far behind the newest stamp of all counts as silent, and what it still
  /// delivers as too late [s].
  double stream_timeout = 1.0;
  /// A step back in time from here on is a reset of the clock, a smaller one a late message [s].
  double clock_reset = 1.0;
  /// A step forward beyond it is believed only when the next message confirms it [s].
  double largest_jump = 10.0;

  /// What a single capture averages at most [s]: the rest that it waits for must not be cut.
  double longestCapture() const { return largest_dwell / 2.0; }
};

/// Throws ConfigError that names the field, its value and the allowed range.
void validate(const SampleBuilderOptions& options);

/// With what tells rest where there are no joint sensors: the tracker, whose turns stand for them.
SampleBuilderOptions restOptions(SampleBuilderOptions options, bool has_joints);

}  // namespace sac
