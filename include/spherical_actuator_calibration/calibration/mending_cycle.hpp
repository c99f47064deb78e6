#pragma once

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"

namespace sac {

/// Whether a cycle makes up for one that ended before it: it succeeded, and was the same one or one
/// that takes everything, a refinement or a motion.
bool mends(const CycleReport& later, const CycleReport& earlier);

}  // namespace sac
