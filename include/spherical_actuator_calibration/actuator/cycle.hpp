#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sac {

/// The cycles of a calibration: level 1, level 2 situations 1 and 2, all parameters at once from
/// dwells, and all at once from motion. Descriptions name those that made them.
enum class Cycle { kJoint, kPoles, kCoil, kRefine, kMotion };

/// joint, poles, coil, refine, motion: as in CalibrationReport messages, descriptions and session
/// databases.
std::string cycleName(Cycle cycle);

/// Names of all cycles.
std::vector<std::string> cycleNames();

/// Inverse of cycleName(): nothing where there is no such cycle.
std::optional<Cycle> cycleNamed(const std::string& name);

}  // namespace sac
