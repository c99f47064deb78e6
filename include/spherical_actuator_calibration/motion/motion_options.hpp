#pragma once

namespace sac {

/// How streams become windows, and what counts as motion.
struct MotionOptions {
  double window = 0.25;         ///< length of a window [s]
  int test_functions = 6;       ///< per window; each gives three residuals
  double least_speed = 0.05;    ///< a rotor that never turns faster in a window rests [rad/s]
  double largest_delay = 0.06;  ///< that is looked for, of currents and tracker [s]
  /// Speed v below which dry friction fades [rad/s].
  double friction_speed = 0.05;
};

}  // namespace sac
