#pragma once

#include <cstddef>
#include <vector>

#include "held_out_measurement.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// Coils of a held-out torque that counts, of which the largest error of an axis that is judged
/// (kLinearRange) would show in it.
std::vector<std::size_t> toldCoils(const HeldOutMeasurement& torque, const ParameterSpace& space);

}  // namespace sac
