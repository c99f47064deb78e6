#pragma once

#include <vector>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"
#include "spherical_actuator_calibration/measurement/pose_to_measure.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What of a pose is measured, by samples that come one after the other: the one rule for all who
/// ask (message PoseProgress). Samples at the pose count (isAtPose()) that are held out as it is. A
/// pattern is measured when one of them has it or its opposite, which tells the same; the pose when
/// all of its patterns are, or, without any, when one sample is there.
///
/// A sample without current is never what is missing. It serves those of its rest, so that it is
/// the first of each visit at which something else is.
class PoseProgress {
 public:
  explicit PoseProgress(PoseToMeasure pose);

  /// `current_threshold` [A]: a coil below it counts as off. Returns whether more is told now.
  bool add(const Sample& sample, double current_threshold);
  /// As before the first sample.
  void beginAnew();

  const PoseToMeasure& pose() const { return pose_; }
  /// Some sample counts: the pose was begun.
  bool hasSample() const { return has_sample_; }
  /// Some sample that counts has a coil excited, of a pattern or not.
  bool hasCurrent() const { return has_current_; }
  /// Patterns that no sample has, in the order of the pose; of a pattern and its opposite one.
  const std::vector<CoilPattern>& missing() const { return missing_; }
  bool isMeasured() const { return missing_.empty() && has_sample_; }

 private:
  PoseToMeasure pose_;
  std::vector<CoilPattern> missing_;
  bool has_sample_ = false;
  bool has_current_ = false;
};

}  // namespace sac
