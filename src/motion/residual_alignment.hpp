#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion_terms.hpp"
#include "spherical_actuator_calibration/motion/motion_summary.hpp"

namespace sac {

/// Of the windows that serve and whose derivatives are kept, where balance() was asked last.
/// `inverse`: of the information of what is estimated, in its order.
ResidualAlignment residualAlignment(const MotionTerms& terms,
                                    const std::vector<Eigen::Index>& estimated,
                                    const Eigen::MatrixXd& inverse);

}  // namespace sac
