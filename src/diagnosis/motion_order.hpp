#pragma once

#include <optional>

#include "motion_wiring.hpp"

namespace sac {

/// What explains a motion best of all that currents may do through coils.
struct MotionOrder {
  /// The order and signs of coils, and those that are dead, however many are not as described, and
  /// up to two poles that are turned or missing; nothing: as it is described, the motion is
  /// explained as well.
  std::optional<SuspectedWiring> mistakes;
  /// With which, to 10 ms [s]; nothing where even the best order leaves much: what is wrong is
  /// something else, and the best delay may be, too.
  std::optional<double> current_delay;
};

/// Of the motion of a session; nothing where it has too few windows, or more than 64 coils. Where
/// inertia is free, all signs at once are told by its sign alone: those that are found are against
/// that of most. By one evaluation of the motion for each of some delays of the currents, and at
/// the best of them for each pole. Precondition: the session has a motion.
std::optional<MotionOrder> orderOfMotion(const CalibrationSession& session);

}  // namespace sac
