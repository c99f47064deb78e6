#pragma once

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// Largest torque of one pole and one coil of nominal strength per ampere [N·m/A]; 0 without a
/// torque model.
double largestTorquePerAmpere(const Actuator& actuator);

}  // namespace sac
