#pragma once

#include "spherical_actuator_calibration/actuator/description_file.hpp"

namespace sac {

/// By how much each axis and offset of an actuator may be off its description [rad], for rehearsals
/// of a motion that goes by it. 30 mrad for a drawing (isAsDrawn());
/// else four of the largest, between 5 and 30 mrad.
double likelyModelError(const CalibratedDescription& description);

}  // namespace sac
