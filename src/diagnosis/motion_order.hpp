#pragma once

#include <optional>

#include "motion_wiring.hpp"

namespace sac {

/// The order, signs and deaths of coils that explain the motion of a session best, however many are
/// not as described; nothing: as it is described, it is explained as well. By one evaluation of the
/// motion for each of some delays of the currents. Precondition: the session has a motion.
std::optional<SuspectedWiring> suspectedOrder(const CalibrationSession& session);

}  // namespace sac
