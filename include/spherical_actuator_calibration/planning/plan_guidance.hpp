#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/planning/planned_pose.hpp"

namespace sac {

/// What of a plan is measured, by samples that come one after the other. A pose is measured when
/// samples at it, held out or not, have each of its patterns or its opposite, or when one is there
/// where it has none.
class PlanProgress {
 public:
  /// `current_threshold` [A]: a coil below it counts as off. Without joints a pose is told as
  /// turns.
  PlanProgress(const std::vector<PlannedPose>& poses,
               double current_threshold,
               bool has_joints = true);

  void add(const Sample& sample);
  /// All samples in use, in the place of those that were added.
  void countAnew(const std::vector<Sample>& samples);
  /// What the operator does next, in a sentence with the pose [rad and degrees] and the coils;
  /// empty when each pose is measured.
  std::string nextStep() const;

 private:
  struct Pose {
    PlannedPose planned;
    std::vector<CoilPattern> open;  ///< that no sample there has
    bool has_sample = false;

    bool isMeasured() const { return open.empty() && has_sample; }
  };

  std::vector<Pose> poses_;
  double current_threshold_;
  bool has_joints_;
};

/// The next step by all samples at once.
std::string planStep(const std::vector<PlannedPose>& poses,
                     const std::vector<Sample>& samples,
                     double current_threshold,
                     bool has_joints = true);

}  // namespace sac
