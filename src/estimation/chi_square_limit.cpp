#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace sac {

double chiSquareLimit(double degrees_of_freedom, double probability) {
  const boost::math::chi_squared_distribution<double> distribution(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(distribution, probability));
}

double chiSquareProbability(double degrees_of_freedom, double value) {
  // Surely reached, to the last digit; of thousands of degrees Boost fails to tell it.
  constexpr double kMany = 100.0;
  constexpr double kNothing = 1e-6;
  if (value <= (degrees_of_freedom > kMany ? kNothing * degrees_of_freedom : 0.0)) {
    return 1.0;
  }
  const boost::math::chi_squared_distribution<double> distribution(degrees_of_freedom);
  return boost::math::cdf(boost::math::complement(distribution, value));
}

}  // namespace sac
