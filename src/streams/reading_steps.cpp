#include "spherical_actuator_calibration/streams/reading_steps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sac {
namespace {

/// Readings are rounded somewhere on their way, at worst to 32 bits [rad].
constexpr double kRounding = 1e-6;
/// Finer steps vanish in any measurement [rad].
constexpr double kFinestStep = 2e-5;
/// Fewer differences have a common divisor by chance.
constexpr int kFewestDifferences = 8;

}  // namespace

void ReadingSteps::add(double reading) {
  const double difference = previous_ ? std::abs(reading - *previous_) : 0.0;
  previous_ = reading;
  if (difference <= kRounding || (differences_ > 0 && divisor_ < kFinestStep)) {
    return;
  }
  // Euclid's algorithm, with rounding.
  double larger = std::max(difference, divisor_);
  double smaller = std::min(difference, divisor_);
  while (smaller > kRounding) {
    const double rest = std::abs(larger - std::round(larger / smaller) * smaller);
    larger = std::exchange(smaller, rest);
  }
  divisor_ = larger;
  ++differences_;
}

double ReadingSteps::step() const {
  return differences_ >= kFewestDifferences && divisor_ >= kFinestStep ? divisor_ : 0.0;
}

}  // namespace sac
