#pragma once

namespace sac {

/// Value that a χ² variable of so many degrees of freedom exceeds with the given probability.
double chiSquareLimit(double degrees_of_freedom, double probability);

/// Probability with which a χ² variable of so many degrees of freedom exceeds a value ≥ 0.
double chiSquareProbability(double degrees_of_freedom, double value);

}  // namespace sac
