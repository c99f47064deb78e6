#pragma once

#include "motion_terms.hpp"

namespace sac {

/// Of the windows that serve, where they were linearised last.
ResidualPace residualPace(const MotionTerms& terms);

}  // namespace sac
