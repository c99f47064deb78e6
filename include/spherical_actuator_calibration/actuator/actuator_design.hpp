#pragma once

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// Throws ConfigError unless `truth` can be the made form of `nominal`: the same joint names, as
/// many poles and coils, both or neither with a torque curve.
void requireSameDesign(const Actuator& nominal, const Actuator& truth);

}  // namespace sac
