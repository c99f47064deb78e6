#pragma once

#include <cstddef>

#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// When an estimate begins, and what is kept for it.
struct LiveMotionOptions {
  std::size_t first_windows = 24;  ///< nothing is told before
  /// The newest ones can be linearised anew. What older ones told stays as it was.
  std::size_t kept_windows = 200;
  /// By so many standard deviations the derivatives of old places may mislead the estimate.
  double tolerance = 0.1;
};

/// What is known after the last window.
struct LiveEstimate {
  bool is_told = false;  ///< else `belief` is the prior
  ParameterBelief belief;
  std::size_t windows = 0;   ///< that came
  std::size_t left_out = 0;  ///< of them: they contradict the others
  double duration = 0.0;     ///< of those that serve [s]
  std::size_t orientations = 0;
  double chi_square = 0.0;  ///< reduced, of the windows that serve; 0: not known
  int linearizations = 0;   ///< of all windows that are kept
};

}  // namespace sac
