#pragma once

#include <cstddef>
#include <optional>

#include "spherical_actuator_calibration/actuator/cycle.hpp"

namespace sac {

/// A cycle as an operator asks for it.
struct CycleRequest {
  Cycle cycle = Cycle::kJoint;
  std::optional<std::size_t> coil = std::nullopt;  ///< the excited one, for kPoles and kCoil only
};

}  // namespace sac
