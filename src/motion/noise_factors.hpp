#pragma once

#include <vector>

#include "motion_terms.hpp"

namespace sac {

/// Factors on the variances of readings and of currents.
struct NoiseFactors {
  double joints = 1.0;
  double currents = 1.0;
};

/// The most likely ones for the residuals of windows that serve, none above 1: what differences of
/// neighbours take for noise can be motion or control, but noise is never larger than they say.
/// `share`: of what the residuals have left of the noise after the solution, below 1.
NoiseFactors likelyFactors(const std::vector<WindowTerm>& windows,
                           double current_variance,
                           double share);

}  // namespace sac
