#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

#include <cmath>

#include "spherical_actuator_calibration/base/angle_difference.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {

bool isAtPose(const Sample& sample, const Eigen::Vector3d& joint_position) {
  const auto is_near = [&](Eigen::Index k) {
    const double apart = angleDifference(sample.joint_position[k], joint_position[k]);
    return std::abs(apart) <= kPoseTolerance;
  };
  return is_near(0) && is_near(1) && is_near(2);
}

CoilPattern patternOf(const Sample& sample, double current_threshold) {
  CoilPattern pattern;
  for (const Excitation& excitation : excitedCoils(sample, current_threshold)) {
    pattern.push_back({excitation.coil, excitation.current < 0.0 ? -1 : 1});
  }
  return pattern;
}

}  // namespace sac
