#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/motion/motion_estimate.hpp"

namespace sac {

/// What the residuals tell of what the model of a motion lacks, by one step from the estimate:
/// other frictions, errors of readings, of the torque curve and of clocks, by the derivatives of
/// windows that are kept, evenly over the recording, and by orientations. `estimated`: coordinates
/// that were. Sets `frictions`, `skew` and `unmodelled` of an estimate whose belief is there.
void probeMotion(const MotionTerms& terms,
                 const MotionOptions& options,
                 const std::vector<Eigen::Index>& estimated,
                 MotionEstimate& found);

}  // namespace sac
