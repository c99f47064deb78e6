#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/group_uncertainty.hpp"
#include "spherical_actuator_calibration/motion/live_estimate.hpp"

namespace sac {

/// What a motion that goes on has told, and what is left to what is wanted, in a sentence.
/// `groups`, `can_be_judged` and `time_left` as MotionFollower has them, `wanted_stddev` in rad.
std::string motionInWords(const LiveEstimate& estimate,
                          const std::vector<GroupUncertainty>& groups,
                          double wanted_stddev,
                          bool can_be_judged,
                          std::optional<double> time_left);

}  // namespace sac
