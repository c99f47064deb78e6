#include "torque_scale.hpp"

#include <algorithm>
#include <cstddef>

namespace sac {

double largeTorque(const std::vector<Sample>& samples, double assumed_stddev) {
  constexpr double kStandsOut = 10.0;  // standard deviations
  constexpr double kLarge = 0.9;
  std::vector<double> sizes;
  for (const Sample& sample : samples) {
    const double stddev = sample.torque_stddev > 0.0 ? sample.torque_stddev : assumed_stddev;
    if (sample.has_torque && sample.torque.norm() > kStandsOut * stddev) {
      sizes.push_back(sample.torque.norm());
    }
  }
  if (sizes.empty()) {
    return 0.0;
  }
  const auto large =
      sizes.begin() + static_cast<std::ptrdiff_t>(kLarge * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), large, sizes.end());
  return *large;
}

}  // namespace sac
