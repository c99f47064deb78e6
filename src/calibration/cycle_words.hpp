#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimate.hpp"

namespace sac {

/// Why a cycle cannot start, or empty.
std::string refusal(const CalibrationModel& model,
                    const CalibrationState& state,
                    const CycleRequest& request,
                    const std::vector<Observation>& observations);

/// Why the numbers of an estimate must not be used, or empty.
std::string failure(const EstimationProblem& problem,
                    const Estimate& estimate,
                    const CycleRequest& request,
                    const EstimationOptions& options);

/// What a successful cycle tells an operator. `unknowns`: directions that the cycle wanted.
std::string successInWords(const CycleRequest& request,
                           const CycleReport& report,
                           std::size_t unknowns,
                           const std::string& coarse,
                           const std::vector<std::string>& advice);

}  // namespace sac
