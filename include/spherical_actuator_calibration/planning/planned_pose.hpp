#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"

namespace sac {

/// One pose to measure at, and what to excite there (message PlannedPose).
struct PlannedPose {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles q [rad]
  std::vector<std::size_t> coils;     ///< that are excited, ascending; none: orientation only
  std::vector<CoilPattern> patterns;  ///< in turn; none: each of the coils alone

  /// The patterns, also where each coil is alone.
  std::vector<CoilPattern> excitations() const {
    return patterns.empty() ? singly(coils) : patterns;
  }
};

}  // namespace sac
