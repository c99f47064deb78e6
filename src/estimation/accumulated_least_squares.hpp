#pragma once

#include "spherical_actuator_calibration/estimation/least_squares.hpp"

namespace sac {

/// The same minimum as solveLeastSquares(), by Levenberg–Marquardt on normal equations that are
/// summed up observation by observation: memory does not grow with their number. Squares the
/// condition number of the Jacobian, so that it loses digits where few observations do not cost
/// time anyway.
LeastSquaresResult solveAccumulatedLeastSquares(const LeastSquaresInput& input);

}  // namespace sac
