#include "spherical_actuator_calibration/planning/pose_progress.hpp"

#include <algorithm>
#include <utility>

#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {
namespace {

/// The opposite of a pattern tells the same.
bool tellsTheSame(const CoilPattern& a, CoilPattern b) {
  if (a == b) {
    return true;
  }
  for (SignedCoil& coil : b) {
    coil.sign = -coil.sign;
  }
  return a == b;
}

}  // namespace

PoseProgress::PoseProgress(PoseToMeasure pose) : pose_(std::move(pose)) {
  beginAnew();
}

bool PoseProgress::add(const Sample& sample, double current_threshold) {
  if (sample.validation != pose_.validation || !isAtPose(sample, pose_.joint_position)) {
    return false;
  }
  const CoilPattern measured = patternOf(sample, current_threshold);
  const auto left =
      std::remove_if(missing_.begin(), missing_.end(), [&](const CoilPattern& pattern) {
        return tellsTheSame(pattern, measured);
      });
  const bool is_first_current = !has_current_ && !measured.empty();
  const bool is_more = !has_sample_ || is_first_current || left != missing_.end();
  missing_.erase(left, missing_.end());
  has_sample_ = true;
  has_current_ = has_current_ || is_first_current;
  return is_more;
}

void PoseProgress::beginAnew() {
  has_sample_ = false;
  has_current_ = false;
  missing_.clear();
  for (const CoilPattern& pattern : pose_.patterns) {
    const bool is_there =
        std::any_of(missing_.begin(), missing_.end(), [&](const CoilPattern& other) {
          return tellsTheSame(pattern, other);
        });
    if (!is_there) {
      missing_.push_back(pattern);
    }
  }
}

}  // namespace sac
