#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How measured currents follow what was commanded: by a lag of first order.
struct CommandResponse {
  double delay = 0.0;  ///< of what was commanded, by the stamps of both [s]
  double lag = 0.0;    ///< time constant [s]
  /// Of the lateness, delay and lag together: each by itself is known less, what the steps between
  /// samples do to a delay as well as this [s].
  double lateness_stddev = 0.0;
};

/// Per stamp and coil [A]. Single precision: fine to a millionth of an ampere, half the memory.
using StreamCurrents = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Currents for their intervals, with the steps between samples that commands tell.
struct CommandedCurrents {
  StreamCurrents currents;
  CommandResponse response;
};

/// Streams of one span of time, each with stamps that increase strictly.
struct MotionStreams {
  using Currents = StreamCurrents;

  std::vector<Stamp> joint_stamps;
  /// Readings [rad], without the jumps of a sensor that wraps around.
  std::vector<Eigen::Vector3d> joints;
  std::vector<Stamp> current_stamps;
  Currents currents;
  /// Known: each current counts for its interval, with the steps between samples that commands
  /// tell. Nothing: currents are as they were sampled.
  std::optional<CommandResponse> response;
  /// Where commands tell the steps, but not well: what they tell, beside the currents as sampled.
  /// Which of both the rotor felt, its motion tells.
  std::shared_ptr<const CommandedCurrents> commanded;
  std::vector<Stamp> orientation_stamps;
  std::vector<Eigen::Quaterniond> orientations;  ///< rotor to stator, unit
};

}  // namespace sac
