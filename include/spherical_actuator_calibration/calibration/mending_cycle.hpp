#pragma once

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"

namespace sac {

/// Whether a cycle makes up for one that ended before it: it succeeded, and was the same one, a
/// motion, or a refinement where the earlier one was no motion.
bool mends(const CycleReport& later, const CycleReport& earlier);

}  // namespace sac
