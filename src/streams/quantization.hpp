#pragma once

namespace sac {

/// Variance of the error that the steps of a sensor leave in the mean of many readings at one
/// place. All means taken there share it. `step`: between two readings [any unit]; `variance`: of
/// single readings, steps included. A quiet sensor reads the same step every time and errs by
/// step²/12; noise of half a step makes the mean as fine as if there were none.
double quantizationVariance(double step, double variance);

}  // namespace sac
