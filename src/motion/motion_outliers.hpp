#pragma once

#include "motion_terms.hpp"

namespace sac {

/// Marks what does not fit as inactive, and as active again what does; whether that changed
/// anything. Where most fit badly, outliers stand out of their scatter. `false_alarm_probability`:
/// of all windows together, and of all orientations.
bool rejectOutliers(MotionTerms& terms, double false_alarm_probability);

}  // namespace sac
