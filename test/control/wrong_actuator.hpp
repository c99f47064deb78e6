#pragma once

#include <cstdint>

#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"
#include "support/scenarios.hpp"

namespace sac {

/// The paper's actuator as it may be built: every parameter is off by up to 30 mrad.
inline Actuator wrongBy30mrad(std::uint64_t seed) {
  constexpr double kError = 0.03;
  return manufacturedActuator(scenarios::paperNominal(), {kError, kError, kError, kError}, seed);
}

}  // namespace sac
