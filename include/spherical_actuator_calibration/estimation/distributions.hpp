#pragma once

#include <cstddef>

namespace sac {

/// Value that a χ² variable of so many degrees of freedom exceeds with the given probability.
double chiSquareLimit(double degrees_of_freedom, double probability);

/// Probability with which a χ² variable of so many degrees of freedom exceeds a value ≥ 0.
double chiSquareProbability(double degrees_of_freedom, double value);

/// Non-centrality of the χ² variable of so many degrees of freedom that stays below a value with
/// the given probability.
double chiSquareNonCentrality(double degrees_of_freedom, double value, double probability);

/// Probability that the variance found in one normal sample is at least so many times that found in
/// another of the same true variance, each of its degrees of freedom.
double varianceRatioProbability(double ratio, double freedom_of_one, double freedom_of_other);

/// Probability that at least so many of `count` come, each of which comes at the rate, 0 to 1.
double binomialTail(std::size_t count, double rate, std::size_t at_least);

/// Value that a standard normal variable stays below with the given probability.
double normalQuantile(double probability);

/// The same for Student's t of so many degrees of freedom.
double studentQuantile(double degrees_of_freedom, double probability);

}  // namespace sac
