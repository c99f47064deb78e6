#pragma once

#include <cstddef>
#include <vector>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// Samples that identify each coil: those with a torque and no other coil excited. Empty without a
/// torque model. One pass over the samples, whatever the number of coils.
std::vector<std::size_t> samplesPerCoil(const CalibrationModel& model,
                                        const std::vector<Sample>& samples,
                                        const EstimationOptions& options);

}  // namespace sac
