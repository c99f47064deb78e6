#pragma once

#include "motion_terms.hpp"

namespace sac {

/// Marks what does not fit as inactive, and as active again what does; whether that changed
/// anything. Where most fit badly, outliers stand out of their scatter. `false_alarm_probability`:
/// of all windows together, and of all orientations.
bool rejectOutliers(MotionTerms& terms, double false_alarm_probability);

/// Leaves out the windows with readings that look like the end of a sensor's range, where a quarter
/// of those with the same end and more contradict the others, beyond what chance makes of how often
/// windows without one do, and at least so many others are there: what that end has cut off is in
/// none of them. Whether anything changed.
bool leaveCutOff(MotionTerms& terms, std::size_t least);

/// Why a window is not sound.
std::string leftOutReason(const WindowTerm& term);

}  // namespace sac
