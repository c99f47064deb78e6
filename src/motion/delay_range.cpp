#include "spherical_actuator_calibration/motion/delay_range.hpp"

#include <algorithm>
#include <cmath>

namespace sac {

std::vector<double> DelayRange::delays() const {
  const int steps = static_cast<int>(std::floor(reach / kStep + 1e-9));
  std::vector<double> all;
  for (int n = -steps; n <= steps; ++n) {
    all.push_back(middle + kStep * n);
  }
  return all;
}

DelayRange DelayRange::about(double delay) const {
  const double farthest = std::max(0.0, reach - kStep);
  return {std::clamp(delay, middle - farthest, middle + farthest), kStep};
}

}  // namespace sac
