#pragma once

#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/control/computed_torque_control.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// How a reference follows its targets.
struct OrientationReferenceOptions {
  double natural_frequency = 12.0;     ///< of its critically damped approach [rad/s]
  double largest_rate = 1.5;           ///< of targets, and of the way to them [rad/s]
  double largest_acceleration = 15.0;  ///< [rad/s²]
  /// Targets that follow each other within this time are points of one motion, whose velocity is
  /// followed without lag; a target that stays alone is a place to go to [s].
  double largest_gap = 0.2;
};

/// Throws ConfigError that names the option and its range.
void validate(const OrientationReferenceOptions& options);

/// Throws DataError unless a target is a rotation.
void requireRotation(const Eigen::Matrix3d& R);

/// Makes a smooth desired motion out of targets: orientations that come one by one, or a stream
/// of them. A critically damped second-order filter on SO(3), limited in rate and acceleration.
class OrientationReference {
 public:
  /// Throws ConfigError when the options are not valid.
  explicit OrientationReference(const OrientationReferenceOptions& options);

  /// At rest at an orientation, which is the target as well.
  void reset(const Eigen::Matrix3d& R_stator_rotor);
  /// A target for the time `stamp`; one that is not newer than the last is a place to go to.
  void setTarget(Stamp stamp, const Eigen::Matrix3d& R_stator_rotor);
  /// Turns the reference by a rotation in the stator frame, as when the measure of orientation
  /// itself has changed. It returns to the target within a second, without a jump of acceleration.
  void turnReference(const Eigen::Matrix3d& rotation_stator);

  /// Motion at the time `now`, `step` ≥ 0 [s] after the last call.
  const DesiredMotion& advance(Stamp now, double step);
  const DesiredMotion& motion() const { return motion_; }

 private:
  bool isMoving(Stamp now) const;
  Eigen::Matrix3d targetAt(Stamp now) const;
  Eigen::Vector3d targetVelocityAt(Stamp now) const;
  Eigen::Matrix3d asideRotation() const;

  OrientationReferenceOptions options_;
  DesiredMotion motion_;
  Eigen::Matrix3d target_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d target_velocity_ = Eigen::Vector3d::Zero();  ///< rotor frame [rad/s]
  double target_interval_ = 0.0;  ///< between the last two targets of a stream [s]
  std::optional<Stamp> target_stamp_;
  Eigen::Vector3d aside_ = Eigen::Vector3d::Zero();  ///< rotation by turnReference(), stator frame
  double aside_age_ = 0.0;                           ///< since then [s]
};

}  // namespace sac
