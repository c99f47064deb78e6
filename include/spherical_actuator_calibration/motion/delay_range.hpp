#pragma once

#include <vector>

#include "spherical_actuator_calibration/motion/motion_options.hpp"

namespace sac {

/// Delays of the currents against the joints that are tried before one is estimated.
struct DelayRange {
  static constexpr double kStep = 0.01;  ///< [s] a descent finds the rest of the way

  double middle = 0.0;                           ///< [s]
  double reach = MotionOptions().largest_delay;  ///< [s] to both sides

  /// Ascending, with the middle among them [s].
  std::vector<double> delays() const;
  /// One of them and its neighbours.
  DelayRange about(double delay) const;
};

}  // namespace sac
