#pragma once

#include "spherical_actuator_calibration/actuator/calibration_record.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Standard deviations of the actuator's values under a state; absent where a value is not
/// identified. A gain is where everything is that it is made of, by a modelled effect.
ParameterStddevs identifiedStddevs(const ParameterSpace& space, const CalibrationState& state);

/// Of the angle of joints, poles and coils that is known worst [rad], as plans and motions count it
/// (definedStddev()); infinite where one is not identified.
double worstStddev(const ParameterSpace& space, const CalibrationState& state);

}  // namespace sac
