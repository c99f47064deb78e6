#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "spherical_actuator_calibration/actuator/cycle.hpp"

namespace sac {

/// A cycle as a title calls it: Joint; Poles with coil 1; Coil 3. `coil` counts from 0.
std::string cycleTitle(Cycle cycle, const std::optional<std::size_t>& coil);

/// All cycles of one kind: Joint; Poles with their coil; Single coils.
std::string cyclesTitle(Cycle cycle);

}  // namespace sac
