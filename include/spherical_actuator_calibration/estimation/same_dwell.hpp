#pragma once

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Whether two consecutive samples are of one dwell, see groupByDwell().
bool isSameDwell(const Sample& one, const Sample& other);

/// Whether errors of a sample are shared with others of its dwell. What an orientation map leaves
/// open is.
bool hasSharedErrors(const Sample& sample, const CalibrationModel& model);

}  // namespace sac
