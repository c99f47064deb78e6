#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"

#include <algorithm>

#include <Eigen/LU>

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
    const Eigen::Vector3d step = linear.d_offset.partialPivLu().solve(error);
    if (!step.allFinite()) {
      return std::nullopt;
    }
    q += step * std::min(1.0, kLargestStep / step.norm());
  }
  return std::nullopt;
}

}  // namespace sac
