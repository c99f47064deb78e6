#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/long_series.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/motion/stream_currents.hpp"

namespace sac {

/// How measured currents follow what was commanded: by a lag of first order.
struct CommandResponse {
  double delay = 0.0;  ///< of what was commanded, by the stamps of both [s]
  double lag = 0.0;    ///< time constant [s]
  /// Of the lateness, delay and lag together: each by itself is known less, what the steps between
  /// samples do to a delay as well as this [s].
  double lateness_stddev = 0.0;
};

/// Currents for their intervals, with the steps between samples that commands tell.
struct CommandedCurrents {
  StreamCurrents currents;
  CommandResponse response;
};

/// Currents that were commanded, each from its stamp on; stamps increase strictly.
struct CommandStream {
  LongSeries<Stamp> stamps;
  StreamCurrents currents;
};

/// Streams of one span of time, each with stamps that increase strictly.
struct MotionStreams {
  LongSeries<Stamp> joint_stamps;
  /// Readings [rad], without the jumps of a sensor that wraps around.
  LongSeries<Eigen::Vector3d> joints;
  LongSeries<Stamp> current_stamps;
  StreamCurrents currents;
  /// Known: each current counts for its interval, with the steps between samples that commands
  /// tell. Nothing: currents are as they were sampled.
  std::optional<CommandResponse> response;
  /// Where commands tell the steps, but not well: what they tell, beside the currents as sampled.
  /// Which of both the rotor felt, its motion tells.
  std::shared_ptr<const CommandedCurrents> commanded;
  LongSeries<Stamp> orientation_stamps;
  LongSeries<Eigen::Quaterniond> orientations;  ///< rotor to stator, unit
};

}  // namespace sac
