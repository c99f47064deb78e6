#pragma once

#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/manufacturing_tolerance.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Tolerance of one coordinate, in its unit.
double toleranceOf(ParameterKind kind, const ManufacturingTolerance& tolerance);

/// Parameters in force with their uncertainty.
struct CalibrationState {
  ParameterBelief belief;
  std::vector<bool> identified;  ///< per coordinate: a cycle has estimated it
};

/// State of a unit that was never calibrated: nominal values, manufacturing tolerance.
CalibrationState nominalState(const ParameterSpace& space, const ManufacturingTolerance& tolerance);

}  // namespace sac
