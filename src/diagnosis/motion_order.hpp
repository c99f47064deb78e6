#pragma once

#include <optional>

#include "motion_wiring.hpp"

namespace sac {

/// The order and signs of coils, and those that are dead, that explain the motion of a session
/// best, however many are not as described; nothing: as it is described, it is explained as well,
/// or there are more than 64 coils. Where inertia is free, all signs at once are told by its sign
/// alone: those that are found are against that of most. By one evaluation of the motion for each
/// of some delays of the currents. Precondition: the session has a motion.
std::optional<SuspectedWiring> suspectedOrder(const CalibrationSession& session);

}  // namespace sac
