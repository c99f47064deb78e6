#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Replaces the measured orientation and torque of a sample, where it has them, by what the sensors
/// would read without noise if the parameters were those at `x` (coordinates of the model's
/// ParameterSpace). All else stays. Precondition: without a torque model the sample has no torque.
void predictMeasurements(const CalibrationModel& model, const Eigen::VectorXd& x, Sample& sample);

}  // namespace sac
