#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace sac {

/// Acquisition time in nanoseconds since the epoch of the clock in use (ROS time at the shells).
using Stamp = std::int64_t;

inline constexpr double kSecondsPerTick = 1e-9;

/// A coil of at least this |current| counts as excited unless the configuration says otherwise [A].
inline constexpr double kExcitationThreshold = 0.05;

/// Seconds from `begin` to `end`.
inline double secondsBetween(Stamp begin, Stamp end) {
  return static_cast<double>(end - begin) * kSecondsPerTick;
}

/// One static dwell with one current pattern: the unit of data of every cycle
/// (message CalibrationSample).
struct Sample {
  std::uint32_t id = 0;
  Stamp stamp = 0;          ///< middle of the dwell
  bool validation = false;  ///< held out: never used to estimate
  /// Raw sensor angles q [rad]; of a rotor without joints see trackedSample().
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d joint_stddev = Eigen::Vector3d::Zero();  ///< of the mean [rad]
  bool has_orientation = false;
  Eigen::Matrix3d R_stator_rotor = Eigen::Matrix3d::Identity();  ///< measured (R_a)
  bool has_torque = false;
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< on the rotor, rotor frame [N·m]
  Eigen::VectorXd current;                           ///< per coil [A]; empty without coils
  double duration = 0.0;                             ///< [s]
  std::uint32_t measurements = 0;                    ///< averaged into it
  double orientation_stddev = 0.0;                   ///< of the mean, per component [rad]
  double torque_stddev = 0.0;                        ///< of the mean, per component [N·m]
  /// Begin of the rest that it belongs to, which others may share; 0: not known.
  Stamp dwell = 0;
  /// Part of joint_stddev that all samples of the dwell share: of the steps of the readings [rad].
  Eigen::Vector3d joint_shared_stddev = Eigen::Vector3d::Zero();
  /// Part of torque_stddev that all samples of the dwell share: of the torque without current that
  /// was taken off, per component [N·m].
  double torque_shared_stddev = 0.0;
};

/// Standard deviation of the error that its joints' readings share with others of its dwell [rad].
/// Where the dwell is not known, samples of one are told by equal readings: their error is one.
inline Eigen::Vector3d sharedJointStddev(const Sample& sample) {
  return sample.dwell != 0 ? sample.joint_shared_stddev : sample.joint_stddev;
}

/// A sample of a rotor without joints with the measured orientation as its reading: joint_position
/// is freeRotorAngles() of it. joint_stddev is then of the error ξ of that orientation, R → e^{ξ̂}R,
/// about x, y and z of the stator; where none is stated, orientation_stddev, or `default_stddev`
/// [rad] without that. Torques weigh with it, and the orientation is no observation beside. Throws
/// DataError when none was measured.
Sample trackedSample(Sample sample, double default_stddev);

/// Throws DataError that names the sample and the field: not finite, a rotation that is none
/// (1e-6), negative uncertainty, or a current vector that has not `coils` entries though the sample
/// carries torque.
void validate(const Sample& sample, std::size_t coils);

}  // namespace sac
