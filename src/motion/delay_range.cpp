#include "spherical_actuator_calibration/motion/delay_range.hpp"

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

}  // namespace sac
