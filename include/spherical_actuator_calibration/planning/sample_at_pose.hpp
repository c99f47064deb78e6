#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Joint angles that differ by at most this from those of a planned pose are at it [rad], as a hand
/// meets it: half of the least spacing of planned poses (PosePlanOptions). Who leads a hand there
/// has it from the message CalibrationStatus.
inline constexpr double kPoseTolerance = 0.05;

/// Whether a sample was taken at planned joint angles, see kPoseTolerance.
bool isAtPose(const Sample& sample, const Eigen::Vector3d& joint_position);

/// Coils that count as excited in a sample, with their signs; one below `current_threshold` [A] is
/// off.
CoilPattern patternOf(const Sample& sample, double current_threshold);

}  // namespace sac
