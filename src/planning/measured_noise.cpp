#include "spherical_actuator_calibration/planning/measured_noise.hpp"

#include <utility>

#include "spherical_actuator_calibration/base/median.hpp"

namespace sac {
namespace {

/// Median of the values [rad] or [N·m] that are told, which are above zero; else what is expected.
double medianTold(const std::vector<double>& values, double expected) {
  std::vector<double> told;
  for (const double value : values) {
    if (value > 0.0) {
      told.push_back(value);
    }
  }
  return told.empty() ? expected : medianOf(std::move(told));
}

}  // namespace

PosePlanOptions withMeasuredNoise(PosePlanOptions options, const std::vector<Sample>& held) {
  std::vector<double> of_orientations;
  std::vector<double> of_torques;
  for (const Sample& sample : held) {
    of_orientations.push_back(sample.has_orientation ? sample.orientation_stddev : 0.0);
    of_torques.push_back(sample.has_torque ? sample.torque_stddev : 0.0);
  }
  options.orientation_stddev = medianTold(of_orientations, options.orientation_stddev);
  options.torque_stddev = medianTold(of_torques, options.torque_stddev);
  for (Eigen::Index joint = 0; joint < options.joint_stddev.size(); ++joint) {
    std::vector<double> of_joint;
    of_joint.reserve(held.size());
    for (const Sample& sample : held) {
      of_joint.push_back(sample.joint_stddev[joint]);
    }
    options.joint_stddev[joint] = medianTold(of_joint, options.joint_stddev[joint]);
  }
  return options;
}

}  // namespace sac
