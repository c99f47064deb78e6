#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

struct PosePlan;

/// What of a plan is measured, by samples that come one after the other. A pose is measured when
/// samples at it, held out or not, have each of its patterns or its opposite, or when one is there
/// where it has none.
class PlanProgress {
 public:
  /// `current_threshold` [A]: a coil below it counts as off. Without joints a pose is told as
  /// turns.
  explicit PlanProgress(double current_threshold, bool has_joints = true)
      : current_threshold_(current_threshold), has_joints_(has_joints) {}

  /// One more pose, before any sample. `patterns`: see PlannedPose::excitations().
  void addPose(const Eigen::Vector3d& joint_position, const std::vector<CoilPattern>& patterns) {
    poses_.push_back({joint_position, patterns, patterns});
  }
  void add(const Sample& sample);
  /// All samples in use, in the place of those that were added.
  void countAnew(const std::vector<Sample>& samples);
  /// What the operator does next, in a sentence with the pose [rad and degrees] and the coils;
  /// empty when each pose is measured.
  std::string nextStep() const;

 private:
  struct Pose {
    Eigen::Vector3d joint_position;
    std::vector<CoilPattern> patterns;
    std::vector<CoilPattern> open;  ///< that no sample there has
    bool has_sample = false;

    bool isMeasured() const { return open.empty() && has_sample; }
  };

  std::vector<Pose> poses_;
  double current_threshold_;
  bool has_joints_;
};

/// What a plan of poses gives, for an operator. `wanted_stddev` [rad]: 0 where none was wanted.
std::string planSentence(const PosePlan& plan, double wanted_stddev);

/// What a plan leaves open, and that more is needed.
std::string openSentence(const PosePlan& plan);

}  // namespace sac
