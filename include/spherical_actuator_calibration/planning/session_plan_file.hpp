#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"
#include "spherical_actuator_calibration/planning/pose_planner.hpp"

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

/// Text of a plan file. Loading gives back poses and expectations to the last bit.
std::string renderSessionPlan(const SessionPlanRecord& record);

/// Reads a plan file. Throws ConfigError that names file, line and key.
SessionPlanRecord loadSessionPlan(const std::string& path);

/// The dwells of a planned session: one per pose, its coils or patterns excited in turn. Throws
/// ConfigError when the plan is for an actuator of another name, for another unit, or for a coil
/// that there is not.
SessionPlan sessionOf(const SessionPlanRecord& record, const Actuator& actuator);

}  // namespace sac
