#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/measurement/registration.hpp"
#include "spherical_actuator_calibration/streams/orientation_history.hpp"
#include "spherical_actuator_calibration/streams/orientation_jump_filter.hpp"
#include "spherical_actuator_calibration/streams/stamp_filter.hpp"

namespace sac {

/// What the force/torque sensor is fixed to. With its load on its tool side, its wrench acts on
/// that body: on the rotor, or on the stator as the reaction.
enum class SensorMount { kRotor, kStator };

/// Of MeasurementBridge.
struct MeasurementBridgeOptions {
  SensorMount sensor_mount = SensorMount::kRotor;
  JumpLimits jumps;
  double clock_reset = 1.0;    ///< a step back from here on is a reset of the clock [s]
  double largest_step = 10.0;  ///< a step forward beyond it must be confirmed by the next one [s]
  // A sensor on the stator needs the orientation at the stamp of its wrench.
  double largest_gap = 0.1;   ///< between two orientations, to interpolate [s]
  double largest_wait = 0.5;  ///< between the stamp of a wrench and the newest one [s]
};

/// Turns measurements of tracker and force/torque sensor into orientation and torque of the rotor,
/// and refuses, with the reason, those that cannot be true. Single-threaded.
class MeasurementBridge {
 public:
  /// Torques that became known, and why others never will, in the order of the wrenches.
  struct Torques {
    std::vector<TorqueMeasurement> measurements;
    std::vector<std::string> refusals;
  };

  explicit MeasurementBridge(const MeasurementBridgeOptions& options);

  /// Rotor orientation of a tracker pose. Throws DataError when the pose is refused: not finite,
  /// no unit quaternion (1e-3), stamps that do not increase, a jump.
  OrientationMeasurement orientation(const MarkerPoseMeasurement& pose,
                                     const Eigen::Isometry3d& X_stator_tracker,
                                     const Eigen::Isometry3d& X_rotor_marker);

  /// Takes a wrench. `X_mount_sensor`: the sensor in the body that carries it. Throws DataError
  /// when the wrench is refused: not finite, stamps that do not increase.
  void add(const WrenchMeasurement& wrench, const Eigen::Isometry3d& X_mount_sensor);

  /// Torques of the wrenches so far. Those of a sensor on the stator may come after the next
  /// orientation; none waits longer than `largest_wait` of stamps.
  Torques takeTorques();

  /// Times that the clock of a stream was reset. Measurements go on afterwards as at the start.
  std::uint64_t clockResets() const { return clock_resets_; }

 private:
  struct WaitingWrench {
    WrenchMeasurement wrench;
    Eigen::Isometry3d X_stator_sensor;
  };

  void judgeStamp(StampFilter& filter, Stamp stamp);
  void restart();
  void answerWaiting();
  /// False when it must wait further.
  bool answer(const WaitingWrench& waiting);

  MeasurementBridgeOptions options_;
  StampFilter pose_stamps_;
  StampFilter wrench_stamps_;
  OrientationJumpFilter jumps_;
  OrientationHistory history_;
  std::deque<WaitingWrench> waiting_;
  Torques ready_;
  Stamp newest_wrench_ = 0;
  std::uint64_t clock_resets_ = 0;
};

}  // namespace sac
