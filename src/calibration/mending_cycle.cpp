#include "spherical_actuator_calibration/calibration/mending_cycle.hpp"

namespace sac {

bool mends(const CycleReport& later, const CycleReport& earlier) {
  const bool is_same = later.cycle == earlier.cycle && later.coil == earlier.coil;
  // Samples tell nothing of inertia, friction and delays.
  const bool takes_everything = later.cycle == Cycle::kMotion ||
                                (later.cycle == Cycle::kRefine && earlier.cycle != Cycle::kMotion);
  return later.success && (is_same || takes_everything);
}

}  // namespace sac
