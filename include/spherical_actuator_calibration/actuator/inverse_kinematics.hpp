#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"

namespace sac {

/// Tilts of a joint below it are short of a gimbal lock [rad].
inline constexpr double kGimbalLock = 1.5;

/// Joint sensor angles q [rad] at which rotorOrientation(joints, q) is R_stator_rotor, by Newton's
/// method from `start`: the solution near it. Nothing where there is none nearby, as close to a
/// gimbal lock.
std::optional<Eigen::Vector3d> jointAngles(const JointGeometry& joints,
                                           const Eigen::Matrix3d& R_stator_rotor,
                                           const Eigen::Vector3d& start);

/// Angles about freeRotorJoints() at which their orientation is R_stator_rotor, exactly: q₂ within
/// ±π/2, the others within ±π [rad]. Where q₂ is ±π/2 only the sum or difference of the others is
/// determined.
Eigen::Vector3d freeRotorAngles(const Eigen::Matrix3d& R_stator_rotor);
/// The same of a quaternion that need not be normalised. Throws DataError unless its norm is 1 to
/// 1e-3.
Eigen::Vector3d freeRotorAngles(const Eigen::Quaterniond& q_stator_rotor);

/// Angles about freeRotorJoints() of the same orientation, by full turns of the third as near to
/// others as they come [rad]: those of a rotor that turns on within its workspace do not jump.
Eigen::Vector3d nearestTurns(const Eigen::Vector3d& angles, const Eigen::Vector3d& others);

}  // namespace sac
