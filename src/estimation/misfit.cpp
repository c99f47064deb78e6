#include "spherical_actuator_calibration/estimation/misfit.hpp"

#include "spherical_actuator_calibration/estimation/distributions.hpp"

namespace sac {

bool isMisfit(double squares, double freedom) {
  constexpr double kSignificance = 1e-3;
  return freedom > 0.0 && squares > chiSquareLimit(freedom, kSignificance);
}

double misfitVariance(double squares, double freedom) {
  return isMisfit(squares, freedom) ? squares / freedom : 1.0;
}

}  // namespace sac
