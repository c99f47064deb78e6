#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Counts samples by the poses that they were taken at: of one pose at most so many, up to `enough`
/// in all.
class PoseCount {
 public:
  /// `least_motion` [rad]: poses differ by that much in some joint.
  PoseCount(double least_motion, std::size_t most_of_a_pose, std::size_t enough)
      : least_motion_(least_motion), most_of_a_pose_(most_of_a_pose), enough_(enough) {}

  void add(const Eigen::Vector3d& joint_position);
  std::size_t count() const { return count_; }
  bool isEnough() const { return count_ == enough_; }

 private:
  double least_motion_;
  std::size_t most_of_a_pose_;
  std::size_t enough_;
  std::size_t count_ = 0;
  std::vector<std::pair<Eigen::Vector3d, std::size_t>> poses_;
};

/// What decides which cycles the samples in use allow, counted sample by sample. Held-out samples
/// do not count.
class SampleCounts {
 public:
  SampleCounts(const CalibrationModel& model, const EstimationOptions& options);
  SampleCounts(const CalibrationModel& model,
               const EstimationOptions& options,
               const std::vector<Sample>& samples);

  void add(const Sample& sample);

  /// With an orientation beside the reading.
  std::size_t orientations() const { return orientations_; }
  /// With an orientation, up to those that are advised for the joint; of one pose no more than
  /// three count, for they tell nothing new.
  std::size_t usefulOrientations() const { return useful_orientations_.count(); }
  /// At different poses, as many orientations as the joint needs.
  bool enoughForJoint() const { return joint_poses_.isEnough(); }
  /// At different poses, as many torques as a refinement needs; without joints, which need poses of
  /// their own, up to three of a pose count.
  bool enoughForRefinement() const { return torque_poses_.isEnough(); }
  /// Per coil, with a torque and no other coil excited; empty without a torque model.
  const std::vector<std::size_t>& perCoil() const { return per_coil_; }
  /// With a torque and several coils excited at once: they serve a refinement only.
  std::size_t ofSeveralCoils() const { return of_several_coils_; }

 private:
  bool model_has_joints_;
  double current_threshold_;
  std::size_t orientations_ = 0;
  PoseCount useful_orientations_;
  PoseCount joint_poses_;
  PoseCount torque_poses_;
  std::vector<std::size_t> per_coil_;
  std::size_t of_several_coils_ = 0;
};

}  // namespace sac
