#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "spherical_actuator_calibration/base/angle_difference.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/base/turns.hpp"

namespace sac {

std::optional<Eigen::Vector3d> jointAngles(const JointGeometry& joints,
                                           const Eigen::Matrix3d& R_stator_rotor,
                                           const Eigen::Vector3d& start) {
  constexpr int kMostIterations = 20;
  constexpr double kConverged = 1e-13;  // [rad]
  constexpr double kLargestStep = 0.5;  // [rad]
  Eigen::Vector3d q = start;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const JointLinearization linear = linearizeRotorOrientation(joints, q);
    const Eigen::Vector3d error = rotationLog(R_stator_rotor * linear.R_stator_rotor.transpose());
    if (error.norm() < kConverged) {
      return q;
    }
    const Eigen::Vector3d step = linear.d_offset.inverse() * error;
    if (!step.allFinite()) {
      return std::nullopt;
    }
    q += step * std::min(1.0, kLargestStep / step.norm());
  }
  return std::nullopt;
}

Eigen::Vector3d freeRotorAngles(const Eigen::Matrix3d& R_stator_rotor) {
  return turnsOf(R_stator_rotor);
}

Eigen::Vector3d freeRotorAngles(const Eigen::Quaterniond& q_stator_rotor) {
  if (!isUnit(q_stator_rotor)) {
    throw DataError("The quaternion has norm " + shortestText(q_stator_rotor.norm()) +
                    " instead of 1.");
  }
  return turnsOf(q_stator_rotor.normalized().toRotationMatrix());
}

Eigen::Vector3d nearestTurns(const Eigen::Vector3d& angles, const Eigen::Vector3d& others) {
  return {angles[0], angles[1], others[2] + angleDifference(angles[2], others[2])};
}

}  // namespace sac
