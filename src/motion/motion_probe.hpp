#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/motion/motion_estimate.hpp"

namespace sac {

/// What the residuals tell of what the model of a motion lacks, by one step from the estimate:
/// other frictions, by the derivatives of windows that are kept, evenly over the recording; a skew
/// of the joints, by these and by orientations. `estimated`: coordinates that were. Sets
/// `frictions` and `skew` of an estimate whose belief is there.
void probeMotion(const MotionTerms& terms,
                 const MotionOptions& options,
                 const std::vector<Eigen::Index>& estimated,
                 MotionEstimate& found);

}  // namespace sac
