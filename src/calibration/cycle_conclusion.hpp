#pragma once

#include <cstdint>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/calibration/cycle_request.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/estimate.hpp"

namespace sac {

/// Coordinates that a cycle asks for, and what became of them.
struct CycleCoordinates {
  std::vector<Eigen::Index> requested;
  std::vector<Eigen::Index> unexcited;     ///< never asked of the data
  std::vector<Eigen::Index> unobservable;  ///< held at the prior whole
};

/// Puts how an estimate was found into the report: iterations, errors, misfit and time.
void reportIteration(const Estimate& estimate, CycleReport& report);

/// What the report says of one observation, whose sample has the number `id`.
SampleResidual reportedResidual(const ObservationResidual& from, std::uint32_t id);

/// Takes a usable estimate over into state and report.
void conclude(const CalibrationModel& model,
              const Estimate& estimate,
              const CycleCoordinates& coordinates,
              ExpectedErrors expected_errors,
              CalibrationState& state,
              CycleReport& report);

}  // namespace sac
