#pragma once

#include <vector>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/calibration/calibration_cycles.hpp"

namespace sac {

/// Puts inertia, friction and unbalance that the last motion of these cycles has told into a
/// description, also where the cycles' model does not know them; nothing without such a motion.
void takeDynamics(const std::vector<CycleReport>& reports, Actuator& actuator);

}  // namespace sac
