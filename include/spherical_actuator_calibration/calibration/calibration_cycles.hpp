#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// A cycle as an operator asks for it.
struct CycleRequest {
  Cycle cycle = Cycle::kJoint;
  std::optional<std::size_t> coil = std::nullopt;  ///< the excited one, for kPoles and kCoil only
};

/// Observations that serve a cycle: held-out samples never do. For kPoles and kCoil those with only
/// the requested coil excited; for kJoint those with an orientation; for kRefine both, with any
/// current pattern.
std::vector<Observation> selectObservations(const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options);

/// Coordinates that a cycle estimates. For kRefine the coils that some sample excites.
std::vector<Eigen::Index> selectCoordinates(const ParameterSpace& space,
                                            const std::vector<Sample>& samples,
                                            const CycleRequest& request,
                                            const EstimationOptions& options);

/// A cycle's report and the state after it: the state before it when the cycle failed.
struct CycleOutcome {
  CycleReport report;
  CalibrationState state;
};

/// Runs one cycle. Never throws for poor data: a refused or failed cycle has success = false and
/// says why. Throws DataError on malformed samples.
CycleOutcome runCycle(const CalibrationModel& model,
                      const std::vector<Sample>& samples,
                      const CalibrationState& state,
                      const CycleRequest& request,
                      const EstimationOptions& options);

}  // namespace sac
