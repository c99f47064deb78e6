#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/emulation/stream_schedule.hpp"
#include "spherical_actuator_calibration/measurement/measurements.hpp"
#include "spherical_actuator_calibration/measurement/registration.hpp"

namespace sac {

/// Joint angle sensors (topic joint_states).
struct EmulatedJointOptions {
  StreamOptions stream = {/*rate=*/200.0, /*phase=*/0.0};
  double noise = 2e-5;                ///< stddev of a reading [rad]
  double quantisation = 4.793690e-5;  ///< step of a reading: a turn / 2¹⁷ [rad]; 0: none
  double glitch = 0.1;                ///< size of a glitch [rad]
};

/// Tracker (topic tracker/pose).
struct TrackerOptions {
  StreamOptions stream = {/*rate=*/120.0, /*phase=*/0.0013};
  double orientation_noise = 1e-3;   ///< uniform within ± this per component [rad]
  double position_noise = 5e-5;      ///< stddev per component [m]
  std::optional<std::size_t> poses;  ///< on at the first so many dwells only
  double glitch = 0.2;               ///< size of a glitch [rad]
  std::size_t bad_dwells = 0;        ///< dwells throughout which the orientation is off
  double bad_dwell_error = 0.05;     ///< by this angle, about a random axis [rad]
};

/// Force/torque sensor between rotor and load (topic ft_sensor/wrench).
struct WrenchSensorOptions {
  StreamOptions stream = {/*rate=*/500.0, /*phase=*/0.0007};
  double force_noise = 0.01;                              ///< stddev per component [N]
  double torque_noise = 2e-3;                             ///< stddev per component [N·m]
  Eigen::Vector3d force_bias = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque_bias = Eigen::Vector3d::Zero();  ///< [N·m]
  double glitch = 0.5;                                    ///< size of a glitch [N·m]
};

/// Current measurement of the coil drivers (topic coil_currents).
struct CurrentSensorOptions {
  StreamOptions stream = {/*rate=*/200.0, /*phase=*/0.0021};
  double noise = 1e-3;                 ///< stddev per coil [A]
  double quantisation = 1.0 / 8192.0;  ///< step of a reading: 16 bit over ±4 A [A]; 0: none
  double glitch = 1.0;                 ///< size of a glitch [A]
};

/// Throw ConfigError that names the option, its value and the allowed range.
void validate(const EmulatedJointOptions& options);
void validate(const TrackerOptions& options);
void validate(const WrenchSensorOptions& options);
void validate(const CurrentSensorOptions& options);

/// Emulated sensors: each turns a true quantity into what its device would deliver. `scheduled`
/// tells whether the measurement is a glitch or not a number.
class EmulatedJointSensor {
 public:
  EmulatedJointSensor(const EmulatedJointOptions& options, std::uint64_t seed);
  /// `position`: exact sensor angles [rad].
  JointMeasurement measure(Stamp stamp,
                           const Eigen::Vector3d& position,
                           const ScheduledMeasurement& scheduled);

 private:
  EmulatedJointOptions options_;
  NoiseSource noise_;
};

/// A tracker, whose measured orientations have its noise and those of its frames.
class EmulatedTracker {
 public:
  /// `dwells`: number of dwells of the session.
  EmulatedTracker(const TrackerOptions& options,
                  const Registration& registration,
                  std::size_t dwells,
                  std::uint64_t seed);
  /// `dwell`: the dwell in which the rotor rests.
  MarkerPoseMeasurement measure(Stamp stamp,
                                const Eigen::Matrix3d& R_stator_rotor,
                                std::optional<std::size_t> dwell,
                                const ScheduledMeasurement& scheduled);

  /// Dwells throughout which the orientation is off, in order.
  std::vector<std::size_t> badDwells() const;

 private:
  TrackerOptions options_;
  Registration registration_;
  NoiseSource noise_;
  std::vector<std::optional<Eigen::Matrix3d>> dwell_errors_;  ///< per dwell, in the stator frame
};

/// A force/torque sensor, whose torques have noise, bias and drift.
class EmulatedWrenchSensor {
 public:
  EmulatedWrenchSensor(const WrenchSensorOptions& options,
                       const Registration& registration,
                       std::uint64_t seed);
  /// `torque_rotor` about the rotor centre [N·m] and `force_rotor` [N], both in the rotor frame.
  WrenchMeasurement measure(Stamp stamp,
                            const Eigen::Vector3d& torque_rotor,
                            const Eigen::Vector3d& force_rotor,
                            const ScheduledMeasurement& scheduled);

 private:
  WrenchSensorOptions options_;
  Registration registration_;
  NoiseSource noise_;
};

/// What an amplifier tells of the currents of its coils.
class EmulatedCurrentSensor {
 public:
  EmulatedCurrentSensor(const CurrentSensorOptions& options, std::uint64_t seed);
  /// `current`: actual coil currents [A]. The result is valid until the next call.
  const CurrentMeasurement& measure(Stamp stamp,
                                    const Eigen::VectorXd& current,
                                    const ScheduledMeasurement& scheduled);

 private:
  CurrentSensorOptions options_;
  NoiseSource noise_;
  CurrentMeasurement measurement_;
};

}  // namespace sac
