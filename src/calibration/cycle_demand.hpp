#pragma once

#include <cstddef>

#include "spherical_actuator_calibration/calibration/cycle_request.hpp"

namespace sac {

/// How many samples a cycle wants.
struct CycleDemand {
  std::size_t needed = 1;   ///< fewest that can tell all that the cycle is to tell
  std::size_t advised = 1;  ///< for a good result (paper, sections 4.1 and 4.2)
};

/// The demand of a cycle of an actuator with so many poles: orientations for kJoint, torques of one
/// coil alone for kPoles and kCoil, samples of any kind for kRefine.
CycleDemand demandOf(Cycle cycle, std::size_t poles);

/// Torques that see a pole, and torques of a coil that see some pole, from which on the pole or
/// coil counts as seen well enough.
inline constexpr std::size_t kAdvisedTorquesPerPole = 3;
inline constexpr std::size_t kAdvisedTorquesPerCoil = 4;

}  // namespace sac
