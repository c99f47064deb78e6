#pragma once

#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/least_squares.hpp"

namespace sac {

/// Where one Gauss–Newton step by what is known at the start leads, with the squared loss, whatever
/// it brings; nothing where no step is defined. Precondition: `at_start`.
std::optional<Eigen::VectorXd> afterOneStep(const LeastSquaresInput& input);

}  // namespace sac
