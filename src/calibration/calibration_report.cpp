#include "spherical_actuator_calibration/calibration/calibration_report.hpp"

#include <cmath>
#include <cstddef>

namespace sac {

std::string unitOf(ErrorMeasure measure) {
  switch (measure) {
    case ErrorMeasure::kOrientation:
      return unitOf(Quantity::kOrientation);
    case ErrorMeasure::kTorque:
      return unitOf(Quantity::kTorque);
    case ErrorMeasure::kStandardized:
      break;
  }
  return "1";
}

std::string quantityName(Quantity quantity) {
  return quantity == Quantity::kOrientation ? "orientation" : "torque";
}

std::string unitOf(Quantity quantity) {
  return quantity == Quantity::kOrientation ? "rad" : "N·m";
}

std::optional<double> residualRms(const CycleReport& report, Quantity quantity) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const SampleResidual& residual : report.residuals) {
    if (residual.quantity == quantity && !residual.rejected) {
      sum += residual.residual * residual.residual;
      ++count;
    }
  }
  return count == 0 ? std::nullopt : std::optional(std::sqrt(sum / static_cast<double>(count)));
}

}  // namespace sac
