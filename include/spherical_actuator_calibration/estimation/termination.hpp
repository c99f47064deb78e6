#pragma once

namespace sac {

/// How a solution ended.
enum class Termination {
  kConverged,
  kIterationLimit,    ///< the most iterations that are allowed, before convergence
  kNumericalFailure,  ///< the solver could not evaluate or factorise
  kTooFewObservations,
  kNothingObservable,
};

}  // namespace sac
