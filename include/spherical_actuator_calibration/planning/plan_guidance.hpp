#pragma once

#include <string>
#include <utility>
#include <vector>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/planning/pose_progress.hpp"

namespace sac {

struct PosePlan;

/// How far a plan is carried out, by samples that come one after the other (message PlanProgress):
/// the progress of each of its poses, in their order.
class PlanProgress {
 public:
  /// `current_threshold` [A]: a coil below it counts as off. Without joints a pose is told as
  /// turns.
  explicit PlanProgress(double current_threshold, bool has_joints = true)
      : current_threshold_(current_threshold), has_joints_(has_joints) {}

  /// One more pose, before any sample.
  void addPose(PoseToMeasure pose) { poses_.emplace_back(std::move(pose)); }
  /// Returns whether more is told now.
  bool add(const Sample& sample);
  /// All samples in use, in the place of those that were added.
  void countAnew(const std::vector<Sample>& samples);

  const std::vector<PoseProgress>& poses() const { return poses_; }
  /// What the operator does next, in a sentence with the pose [rad and degrees] and the coils;
  /// empty when each pose is measured.
  std::string nextStep() const;

 private:
  std::vector<PoseProgress> poses_;
  double current_threshold_;
  bool has_joints_;
};

/// What a plan of poses gives, for an operator. `wanted_stddev` [rad]: 0 where none was wanted.
std::string planSentence(const PosePlan& plan, double wanted_stddev);

/// What a plan leaves open, and that more is needed.
std::string openSentence(const PosePlan& plan);

}  // namespace sac
