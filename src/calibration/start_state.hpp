#pragma once

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"

namespace sac {

/// State before any cycle: nominal values with the tolerance of manufacture, and what a description
/// that was calibrated before states.
CalibrationState startState(const ParameterSpace& space,
                            const CalibratedDescription& start,
                            const ManufacturingTolerance& tolerance);

}  // namespace sac
