#pragma once

#include <string>
#include <vector>

#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/motion/delay_range.hpp"
#include "spherical_actuator_calibration/motion/motion_recording.hpp"
#include "wiring_case.hpp"

namespace sac {

/// Mistakes that a motion may have been recorded with.
struct SuspectedWiring {
  Candidate parts;
  double share_left = 1.0;  ///< of the misfit as described, without them
};

/// Mistakes at coils, poles and of the unit of currents that the motion of a session may have been
/// recorded with, two at the most together, the most promising first; none: as it is described, it
/// is explained as well. By how much misfit one step from the description leaves: where all axes
/// are off, coils that counteract each other tell so little of strengths that these cannot be asked
/// for. `known`: mistakes that there are beside them. `delays`: of the currents, that are tried.
/// Precondition: the session has a motion.
std::vector<SuspectedWiring> suspectedWiring(const CalibrationSession& session,
                                             const Candidate& known,
                                             const DelayRange& delays);

/// Those that suspectedWiring() looks for, one by one.
Candidate motionMistakes(const Actuator& actuator);

/// What would have been recorded without the mistakes of a candidate.
struct CorrectedMotion {
  Actuator actuator;
  MotionRecording recording;
};

CorrectedMotion correctedMotion(const Actuator& actuator,
                                const MotionRecording& recording,
                                const Candidate& candidate);

}  // namespace sac
