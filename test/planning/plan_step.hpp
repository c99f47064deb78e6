#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/planning/plan_guidance.hpp"
#include "spherical_actuator_calibration/planning/planned_pose.hpp"

namespace sac {

/// The next step by all samples at once.
inline std::string planStep(const std::vector<PlannedPose>& poses,
                            const std::vector<Sample>& samples,
                            double current_threshold,
                            bool has_joints = true) {
  PlanProgress progress(current_threshold, has_joints);
  for (const PlannedPose& pose : poses) {
    progress.addPose({pose.joint_position, pose.excitations()});
  }
  progress.countAnew(samples);
  return progress.nextStep();
}

}  // namespace sac
