#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_terms.hpp"

namespace sac {

/// What the residuals tell of each friction that the model lacks, by one step from the estimate in
/// the derivatives of the windows that are kept. What the parameters would take up of it is not
/// counted as told. `covariance`: of the coordinates that were estimated, by the noise as it is
/// stated.
std::vector<OtherFriction> probedFriction(const MotionTerms& terms,
                                          const Eigen::VectorXd& x,
                                          const std::vector<Eigen::Index>& estimated,
                                          const Eigen::MatrixXd& covariance);

}  // namespace sac
