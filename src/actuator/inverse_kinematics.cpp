#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "spherical_actuator_calibration/base/angle_difference.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/number_text.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"

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
  const Eigen::Matrix3d& R = R_stator_rotor;
  const double q1 = std::atan2(-R(1, 2), R(2, 2));
  // Of e^{−x̂q₁}R the second row is (sin q₃, cos q₃, 0) whatever q₁ is made of: near q₂ = ±π/2 that
  // is rounding errors.
  const Eigen::RowVector3d row = std::cos(q1) * R.row(1) + std::sin(q1) * R.row(2);
  return {q1, std::atan2(R(0, 2), std::hypot(R(1, 2), R(2, 2))), std::atan2(row[0], row[1])};
}

Eigen::Vector3d freeRotorAngles(const Eigen::Quaterniond& q_stator_rotor) {
  if (!isUnit(q_stator_rotor)) {
    throw DataError("The quaternion has norm " + shortestText(q_stator_rotor.norm()) +
                    " instead of 1.");
  }
  return freeRotorAngles(q_stator_rotor.normalized().toRotationMatrix());
}

Eigen::Vector3d nearestTurns(const Eigen::Vector3d& angles, const Eigen::Vector3d& others) {
  return {angles[0], angles[1], others[2] + angleDifference(angles[2], others[2])};
}

}  // namespace sac
