#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/planning/pose_plan.hpp"

namespace sac {

/// A planned session as kept in a file: for people, and for whoever carries it out.
struct SessionPlanRecord {
  std::string actuator;  ///< name in the description
  std::string serial;    ///< of the unit; may be empty
  std::string software;  ///< version of this package
  std::string cycle;     ///< that is planned for: refine, joint, poles:1, coil:3

  /// What the plan assumes: see PosePlanOptions.
  double current = 0.0;  ///< of an excited coil [A]
  bool tracker_on = true;
  Eigen::Vector3d joint_stddev = Eigen::Vector3d::Zero();  ///< [rad]
  double orientation_stddev = 0.0;                         ///< [rad]
  double torque_stddev = 0.0;                              ///< [N·m]
  std::size_t samples_held = 0;                            ///< that count, measured before

  PosePlan plan;
};

}  // namespace sac
