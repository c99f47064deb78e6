#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"

namespace sac {

/// A pose that was planned, as a session remembers it.
struct StoredPose {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles [rad]
  std::vector<CoilPattern> patterns;                         ///< in turn; none: orientation only
  bool validation = false;                                   ///< to judge: its samples are held out

  friend bool operator==(const StoredPose& a, const StoredPose& b) {
    return a.joint_position == b.joint_position && a.patterns == b.patterns &&
           a.validation == b.validation;
  }
};

/// In the order in which poses are measured.
using StoredPlan = std::vector<StoredPose>;

}  // namespace sac
