#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/least_squares.hpp"

namespace sac {

/// The minimum of solveLeastSquares() by other means: Ceres with an orthogonal factorisation of all
/// rows at once, down to its rounding.
LeastSquaresResult solveWithCeres(const LeastSquaresInput& input);

}  // namespace sac
