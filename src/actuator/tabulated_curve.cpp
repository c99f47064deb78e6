#include "spherical_actuator_calibration/actuator/tabulated_curve.hpp"

#include <algorithm>
#include <cmath>

namespace sac {

TabulatedCurve::TabulatedCurve(const TorqueCurve& curve) : first_(curve.cosSupportEnd()) {
  constexpr std::size_t kIntervals = 4096;
  per_kappa_ = static_cast<double>(kIntervals) / (1.0 - first_);
  nodes_.reserve(kIntervals + 1);
  for (std::size_t n = 0; n <= kIntervals; ++n) {
    const double kappa = std::min(first_ + static_cast<double>(n) / per_kappa_, 1.0);
    const TorqueCurve::Safe safe = curve.safe(kappa, std::sqrt((1.0 - kappa) * (1.0 + kappa)));
    nodes_.push_back({safe.h, safe.dh / per_kappa_});
  }
}

}  // namespace sac
