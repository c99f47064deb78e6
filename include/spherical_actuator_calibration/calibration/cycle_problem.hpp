#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Observations that serve a cycle: held-out samples never do. For kPoles and kCoil those with only
/// the requested coil excited; for kJoint those with an orientation; for kRefine both, with any
/// current pattern. Orientations of a rotor without joints are none, but readings.
std::vector<Observation> selectObservations(const ParameterSpace& space,
                                            const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options);

/// Coordinates that a cycle estimates. For kRefine the coils that some sample excites.
std::vector<Eigen::Index> selectCoordinates(const ParameterSpace& space,
                                            const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options);

}  // namespace sac
