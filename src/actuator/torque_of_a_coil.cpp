#include "torque_of_a_coil.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {

void requireTorqueOfACoil(const TorqueCurveDescription& description) {
  constexpr double kLeastPeak = 1e-9;  // [N·m/A]
  constexpr double kMostPeak = 1e3;
  constexpr int kSteps = 400;
  const TorqueCurve curve(description);
  double peak = 0.0;
  for (int n = 0; n <= kSteps; ++n) {
    peak = std::max(peak, std::abs(curve.value(curve.supportEnd() * n / kSteps)));
  }
  const std::string found =
      format("%s: the largest torque is %.3g N*m/A",
             description.table.empty() ? "torque_curve" : "torque_curve.table",
             peak);
  if (peak < kLeastPeak) {
    throw ConfigError(found + ", with which no coil does anything; torques are in N*m/A.");
  }
  if (!(peak < kMostPeak)) {
    throw ConfigError(found + ", which no coil has; torques are in N*m/A, angles in angle_unit.");
  }
}

}  // namespace sac
