#pragma once

#include <cstddef>

namespace sac {

/// How streams become windows, and what counts as motion.
struct MotionOptions {
  double window = 0.25;         ///< length of a window [s]
  int test_functions = 6;       ///< per window; each gives three residuals
  double least_speed = 0.05;    ///< a rotor that never turns faster in a window rests [rad/s]
  double largest_delay = 0.06;  ///< that is looked for, of currents and tracker [s]
  /// Every so manieth window judges before it serves, where there are enough of them; 0: none.
  std::size_t hold_out_every = 10;
  std::size_t least_windows_to_hold_out = 40;
  /// Speed v below which dry friction fades [rad/s].
  double friction_speed = 0.05;
  /// Of more windows so many serve, evenly over the recording; 0: all.
  std::size_t most_windows = 0;
  /// Derivatives of so many windows are kept; of longer recordings sums, and fewer of them.
  std::size_t most_kept_windows = 260;
};

}  // namespace sac
