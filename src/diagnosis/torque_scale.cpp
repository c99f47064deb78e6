#include "torque_scale.hpp"

#include <algorithm>
#include <cmath>

namespace sac {

double largestTorquePerAmpere(const Actuator& actuator) {
  if (!actuator.hasTorqueModel()) {
    return 0.0;
  }
  const TorqueCurve curve(*actuator.torque_curve);
  constexpr int kSteps = 60;
  double largest = 0.0;
  for (int n = 1; n < kSteps; ++n) {
    largest = std::max(largest, std::abs(curve.value(curve.supportEnd() * n / kSteps)));
  }
  return largest;
}

}  // namespace sac
