#pragma once

#include "spherical_actuator_calibration/estimation/model_point.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Replaces the measured orientation and torque of a sample, where it has them, by what the sensors
/// would read without noise if the parameters were those of the point. All else stays.
/// Precondition: without a torque model the sample has no torque.
void predictMeasurements(const ModelPoint& point, Sample& sample);

}  // namespace sac
