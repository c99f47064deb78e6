#include "residual_pace.hpp"

#include <cmath>

#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {

double ResidualPace::probability() const {
  const double ratio = slow / fast;
  return freedom > 0.0 && std::isfinite(ratio) ? varianceRatioProbability(ratio, freedom, freedom)
                                               : 1.0;
}

ResidualPace residualPace(const MotionTerms& terms) {
  ResidualPace pace;
  const Eigen::Index half = 3 * (terms.valuesPerWindow() / 6);
  for (const WindowTerm& term : terms.windows()) {
    if (term.serves() && term.residual.size() > 0) {
      pace.slow += term.residual.head(half).squaredNorm();
      pace.fast += term.residual.tail(half).squaredNorm();
      pace.freedom += static_cast<double>(half);
    }
  }
  if (pace.freedom > 0.0) {
    pace.slow /= pace.freedom;
    pace.fast /= pace.freedom;
  }
  return pace;
}

}  // namespace sac
