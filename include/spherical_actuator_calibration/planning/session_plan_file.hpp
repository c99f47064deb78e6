#pragma once

#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/measurement/session_plan.hpp"

namespace sac {

struct SessionPlanRecord;

/// Text of a plan file. Loading gives back poses and expectations to the last bit.
std::string renderSessionPlan(const SessionPlanRecord& record);

/// Reads a plan file. Throws ConfigError that names file, line and key.
SessionPlanRecord loadSessionPlan(const std::string& path);

/// Reads the plan of a session of this actuator. Throws ConfigError, beside the above, when it has
/// no pose, is for an actuator of another name, for another unit or for a coil that there is not,
/// or has a pose beyond the workspace.
SessionPlanRecord loadSessionPlanFor(const Actuator& actuator, const std::string& path);

/// The dwells of the plan in a file: one per pose, its coils or patterns excited in turn. Throws
/// what loadSessionPlanFor() throws.
SessionPlan loadPlannedSession(const std::string& path, const Actuator& actuator);

}  // namespace sac
