#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"

namespace sac {

/// A pose, and what is excited there (message PosePatterns).
struct PoseToMeasure {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles q [rad]
  std::vector<CoilPattern> patterns;                         ///< in turn; none: orientation only
  bool validation = false;  ///< to judge: samples that are held out count, and no others

  friend bool operator==(const PoseToMeasure& a, const PoseToMeasure& b) {
    return a.joint_position == b.joint_position && a.patterns == b.patterns &&
           a.validation == b.validation;
  }
};

/// In the order in which they are measured: the plan that a session follows, and remembers.
using PosesToMeasure = std::vector<PoseToMeasure>;

}  // namespace sac
