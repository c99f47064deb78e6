#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_terms.hpp"

namespace sac {

/// What the residuals tell of each friction that the model lacks, by one step from the estimate in
/// the derivatives of windows that are kept, evenly over the recording. What the parameters could
/// take up of it there is not counted as told. `estimated`: coordinates that were.
std::vector<OtherFriction> probedFriction(const MotionTerms& terms,
                                          const Eigen::VectorXd& x,
                                          const std::vector<Eigen::Index>& estimated);

}  // namespace sac
