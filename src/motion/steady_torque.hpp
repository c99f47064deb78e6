#pragma once

#include <optional>

#include "motion_terms.hpp"

namespace sac {

/// Windows one after the other.
struct WindowRun {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Over which windows something held or turned the rotor, as a hand does, or a cable: by a torque
/// too small to show in any of them, but the same in all. Nothing: by none that is beyond chance.
/// Only those that serve tell of it.
std::optional<WindowRun> steadilyPushed(const MotionTerms& terms);

}  // namespace sac
