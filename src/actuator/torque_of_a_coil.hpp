#pragma once

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

namespace sac {

/// Throws ConfigError for a valid curve that no coil has: (nearly) zero everywhere, or so large
/// that its torques are in another unit.
void requireTorqueOfACoil(const TorqueCurveDescription& description);

}  // namespace sac
