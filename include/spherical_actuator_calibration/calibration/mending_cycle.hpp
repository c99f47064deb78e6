#pragma once

#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"

namespace sac {

/// Whether a cycle makes up for one that ended before it: it succeeded, and was the same one, a
/// motion, or a refinement where the earlier one was no motion.
bool mends(const CycleReport& later, const CycleReport& earlier);

/// Of cycles in their order those that no later one makes up for, the newest first.
std::vector<const CycleReport*> unmended(const std::vector<CycleReport>& reports);

}  // namespace sac
