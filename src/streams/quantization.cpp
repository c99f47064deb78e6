#include "quantization.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {

double quantizationVariance(double step, double variance) {
  constexpr int kHarmonics = 200;
  if (step <= 0.0) {
    return 0.0;
  }
  // The mean error is periodic in the place: noise of standard deviation s leaves exp(−2π²k²s²) of
  // its k-th harmonic, whose amplitude is 1/(πk), in steps (Widrow and Kollár, Quantization Noise).
  const double noise = std::max(variance / (step * step) - 1.0 / 12.0, 0.0);
  double sum = 0.0;
  for (int k = 1; k <= kHarmonics; ++k) {
    const double order = static_cast<double>(k) * static_cast<double>(k);
    sum += std::exp(-4.0 * kPi * kPi * order * noise) / (2.0 * kPi * kPi * order);
  }
  return sum * step * step;
}

}  // namespace sac
