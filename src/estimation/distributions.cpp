#include "spherical_actuator_calibration/estimation/distributions.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

// All that the package asks of Boost.Math stands here: each source that includes it takes seconds.
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

double chiSquareNonCentrality(double degrees_of_freedom, double value, double probability) {
  return boost::math::non_central_chi_squared::find_non_centrality(
      degrees_of_freedom, value, probability);
}

double varianceRatioProbability(double ratio, double freedom_of_one, double freedom_of_other) {
  const boost::math::fisher_f_distribution<double> distribution(freedom_of_one, freedom_of_other);
  return boost::math::cdf(boost::math::complement(distribution, ratio));
}

double binomialTail(std::size_t count, double rate, std::size_t at_least) {
  if (at_least == 0) {
    return 1.0;
  }
  const boost::math::binomial_distribution<double> distribution(static_cast<double>(count), rate);
  return boost::math::cdf(
      boost::math::complement(distribution, static_cast<double>(at_least) - 1.0));
}

double normalQuantile(double probability) {
  return boost::math::quantile(boost::math::normal_distribution<double>(), probability);
}

double studentQuantile(double degrees_of_freedom, double probability) {
  return boost::math::quantile(boost::math::students_t_distribution<double>(degrees_of_freedom),
                               probability);
}

}  // namespace sac
