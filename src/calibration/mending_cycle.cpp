#include "spherical_actuator_calibration/calibration/mending_cycle.hpp"

#include <algorithm>

namespace sac {

bool mends(const CycleReport& later, const CycleReport& earlier) {
  const bool is_same = later.cycle == earlier.cycle && later.coil == earlier.coil;
  // Samples tell nothing of inertia, friction and delays.
  const bool takes_everything = later.cycle == Cycle::kMotion ||
                                (later.cycle == Cycle::kRefine && earlier.cycle != Cycle::kMotion);
  return later.success && (is_same || takes_everything);
}

std::vector<const CycleReport*> unmended(const std::vector<CycleReport>& reports) {
  std::vector<const CycleReport*> last;
  for (auto report = reports.rbegin(); report != reports.rend(); ++report) {
    const bool is_mended = std::any_of(
        reports.rbegin(), report, [&](const CycleReport& later) { return mends(later, *report); });
    if (!is_mended) {
      last.push_back(&*report);
    }
  }
  return last;
}

}  // namespace sac
