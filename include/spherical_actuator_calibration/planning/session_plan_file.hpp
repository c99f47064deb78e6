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

/// The dwells of a planned session: one per pose, its coils or patterns excited in turn. Throws
/// ConfigError when the plan is for an actuator of another name, for another unit, or for a coil
/// that there is not.
SessionPlan sessionOf(const SessionPlanRecord& record, const Actuator& actuator);

/// The dwells of the plan in a file: loadSessionPlan() and sessionOf() at once.
SessionPlan loadPlannedSession(const std::string& path, const Actuator& actuator);

}  // namespace sac
