#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
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

/// Takes a usable estimate over into state and report.
void conclude(const CalibrationModel& model,
              const Estimate& estimate,
              const CycleCoordinates& coordinates,
              CalibrationState& state,
              CycleReport& report);

}  // namespace sac
