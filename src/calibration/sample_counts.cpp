#include "spherical_actuator_calibration/calibration/sample_counts.hpp"

#include <algorithm>
#include <cmath>

#include "cycle_demand.hpp"
#include "spherical_actuator_calibration/base/angle_difference.hpp"

namespace sac {
namespace {

constexpr std::size_t kMostOfAPose = 3;

}  // namespace

void PoseCount::add(const Eigen::Vector3d& joint_position) {
  if (isEnough()) {
    return;
  }
  const auto is_near = [&](const Eigen::Vector3d& known, Eigen::Index k) {
    return std::abs(angleDifference(known[k], joint_position[k])) < least_motion_;
  };
  auto pose = std::find_if(poses_.begin(), poses_.end(), [&](const auto& known) {
    return is_near(known.first, 0) && is_near(known.first, 1) && is_near(known.first, 2);
  });
  if (pose == poses_.end()) {
    pose = poses_.insert(poses_.end(), {joint_position, 0});
  }
  count_ += ++pose->second <= most_of_a_pose_ ? 1 : 0;
}

SampleCounts::SampleCounts(const CalibrationModel& model, const EstimationOptions& options)
    : model_has_joints_(model.space().joints() > 0),
      current_threshold_(options.current_threshold),
      useful_orientations_(options.min_joint_motion,
                           kMostOfAPose,
                           demandOf(Cycle::kJoint, model.space().poles()).advised),
      joint_poses_(
          options.min_joint_motion, 1, demandOf(Cycle::kJoint, model.space().poles()).needed),
      torque_poses_(options.min_joint_motion,
                    model_has_joints_ ? 1 : kMostOfAPose,
                    demandOf(Cycle::kRefine, model.space().poles()).needed),
      per_coil_(model.hasTorqueModel() ? model.space().coils() : 0, 0) {}

SampleCounts::SampleCounts(const CalibrationModel& model,
                           const EstimationOptions& options,
                           const std::vector<Sample>& samples)
    : SampleCounts(model, options) {
  for (const Sample& sample : samples) {
    add(sample);
  }
}

void SampleCounts::add(const Sample& sample) {
  if (sample.validation) {
    return;
  }
  if (model_has_joints_ && sample.has_orientation) {
    ++orientations_;
    useful_orientations_.add(sample.joint_position);
    joint_poses_.add(sample.joint_position);
  }
  if (!sample.has_torque) {
    return;
  }
  torque_poses_.add(sample.joint_position);
  if (per_coil_.empty()) {
    return;
  }
  const std::vector<Excitation> excited = excitedCoils(sample, current_threshold_);
  if (excited.size() == 1) {
    ++per_coil_.at(excited.front().coil);
  } else if (excited.size() > 1) {
    ++of_several_coils_;
  }
}

}  // namespace sac
