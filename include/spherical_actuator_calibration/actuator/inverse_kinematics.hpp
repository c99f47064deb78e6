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

}  // namespace sac
