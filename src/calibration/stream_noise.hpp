#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"

namespace sac {

/// What the residuals of one sensor say of its noise: squares of what the estimate takes for noise,
/// in units of what the samples state.
struct StreamNoise {
  std::string name;
  double squares = 0.0;
  /// What they would be on average. Parameters and shared errors take the rest of the values up, so
  /// that χ² of as many degrees of freedom spreads as widely or wider: its limits are safe.
  double freedom = 0.0;
};

/// Orientations, torques, and readings that all measurements of a dwell share. Of long sessions a
/// part, which tells enough. Precondition: the estimate converged.
std::vector<StreamNoise> streamNoise(const EstimationProblem& problem,
                                     const Estimate& estimate,
                                     const EstimationOptions& options);

/// A sentence for each stream whose noise is notably another than stated, which is none of chance.
/// An orientation map follows the samples that it is found from: that little is left of them then
/// tells nothing of their noise.
std::vector<std::string> noiseInWords(const std::vector<StreamNoise>& streams, bool has_map);

}  // namespace sac
