#pragma once

#include <algorithm>
#include <cmath>

namespace sac {

/// How near a measured current is to the one commanded where the coil carries it: the service
/// capture_planned judges by it for a capture, check_coils for who looks at coils.
struct CurrentTolerance {
  double absolute = 0.0;  ///< [A]
  double share = 0.0;     ///< of the command, where that is more [1]

  bool allows(double measured, double commanded) const {
    return std::abs(measured - commanded) <= std::max(absolute, share * std::abs(commanded));
  }
};

/// Whether a coil with so much measured current [A] counts as excited: from `threshold` [A] on.
inline bool isExcited(double current, double threshold) {
  return std::abs(current) >= threshold;
}

/// Of a coil that counts as excited from `threshold` [A] on: what is off by it counts as off. A
/// tenth is what amplifiers miss, and the measured current is what estimates take.
inline CurrentTolerance currentTolerance(double threshold) {
  return {0.8 * threshold, 0.1};
}

/// The least command [A] that leaves a coil excited wherever the tolerance lets its current be.
inline double leastExcitation(double threshold) {
  return threshold + currentTolerance(threshold).absolute;
}

}  // namespace sac
