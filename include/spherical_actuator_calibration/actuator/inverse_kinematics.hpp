#pragma once

#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"

namespace sac {

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

}  // namespace sac
