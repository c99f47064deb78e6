#include "spherical_actuator_calibration/planning/linearity_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"
#include "spherical_actuator_calibration/planning/sample_at_pose.hpp"

namespace sac {
namespace {

/// Of the full current.
constexpr std::array<double, 3> kShares = {1.0, 0.5, -1.0};
constexpr double kLeastShare = 0.5;

bool isAlone(const CoilPattern& pattern) {
  return pattern.size() == 1;
}

/// Of all samples at the pose that one with the most torque; one coil alone before several.
const Sample* strongestOf(const std::vector<const Sample*>& there, double threshold) {
  const Sample* strongest = nullptr;
  bool is_alone = false;
  for (const Sample* sample : there) {
    const CoilPattern pattern = patternOf(*sample, threshold);
    if (pattern.empty() || (is_alone && !isAlone(pattern))) {
      continue;
    }
    const bool is_first_alone = isAlone(pattern) && !is_alone;
    if (strongest == nullptr || is_first_alone ||
        sample->torque.norm() > strongest->torque.norm()) {
      strongest = sample;
      is_alone = isAlone(pattern);
    }
  }
  return strongest;
}

/// Whether a sample is of the pattern, and nearly at its current.
bool serves(const Sample& sample, const PlannedCapture& planned, double threshold) {
  constexpr double kNear = 0.2;  // of the current
  // One that has no currents is of no pattern.
  return patternOf(sample, threshold) == planned.pattern &&
         std::abs(sample.current.cwiseAbs().maxCoeff() - planned.current) <=
             kNear * planned.current;
}

}  // namespace

LinearityPlan linearityPlan(const std::vector<Sample>& held,
                            const PoseToMeasure& pose,
                            double current,
                            double current_threshold) {
  LinearityPlan plan;
  if (pose.validation || pose.patterns.empty() ||
      kLeastShare * current < leastExcitation(current_threshold)) {
    return plan;
  }
  const bool has_full = std::any_of(pose.patterns.begin(), pose.patterns.end(), isAlone);
  plan.captures = kShares.size() - (has_full ? 1 : 0);
  std::vector<const Sample*> there;
  Stamp rest = 0;
  for (const Sample& sample : held) {
    if (!sample.validation && isAtPose(sample, pose.joint_position)) {
      there.push_back(&sample);
      rest = std::max(rest, sample.dwell);
    }
  }
  const Sample* strongest = strongestOf(there, current_threshold);
  if (strongest == nullptr) {
    return plan;
  }
  const std::size_t coil = patternOf(*strongest, current_threshold).front().coil;
  for (const double share : kShares) {
    const PlannedCapture wanted = {
        pose.joint_position, {{coil, share > 0.0 ? 1 : -1}}, std::abs(share) * current};
    const bool is_held = std::any_of(held.begin(), held.end(), [&](const Sample& sample) {
      return sample.dwell == rest && serves(sample, wanted, current_threshold);
    });
    if (!is_held) {
      plan.missing.push_back(wanted);
    }
  }
  return plan;
}

}  // namespace sac
