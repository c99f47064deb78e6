#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/calibration/cycle_problem.hpp"
#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
#include "spherical_actuator_calibration/calibration/motion_evidence.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// A cycle's report and the state after it: the state before it when the cycle failed.
struct CycleOutcome {
  CycleReport report;
  CalibrationState state;
};

/// Runs one cycle. Never throws for poor data: a refused or failed cycle has success = false and
/// says why. What a motion told counts beside the samples; where both contradict each other, the
/// cycle is refused. Throws DataError on malformed samples.
CycleOutcome runCycle(const CalibrationModel& model,
                      const std::vector<Sample>& samples,
                      const CalibrationState& state,
                      const CycleRequest& request,
                      const EstimationOptions& options,
                      const MotionEvidence* motion = nullptr);

}  // namespace sac
