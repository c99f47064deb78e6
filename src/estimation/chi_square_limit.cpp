#include "spherical_actuator_calibration/estimation/chi_square_limit.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace sac {

double chiSquareLimit(double degrees_of_freedom, double probability) {
  const boost::math::chi_squared_distribution<double> distribution(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(distribution, probability));
}

double chiSquareProbability(double degrees_of_freedom, double value) {
  if (value <= 0.0) {
    return 1.0;  // which Boost fails to tell of thousands of degrees
  }
  const boost::math::chi_squared_distribution<double> distribution(degrees_of_freedom);
  return boost::math::cdf(boost::math::complement(distribution, value));
}

}  // namespace sac
