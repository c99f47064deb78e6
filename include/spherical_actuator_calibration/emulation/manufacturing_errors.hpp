#pragma once

#include <cstdint>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// How far a made actuator may be from its drawing: every error is uniform within ± its bound.
struct ManufacturingErrors {
  double joint_offset = 0.03;  ///< [rad]
  double joint_axis = 0.03;    ///< along each of two directions across the axis [rad]
  double pole_angle = 0.02;    ///< polar and azimuth [rad]
  double coil_angle = 0.02;    ///< polar and azimuth [rad]
  double strength = 0.0;       ///< of the gains of poles and coils, share of the nominal gain
  /// By which the true torque curve is wider in angle than the drawn one, as a share: of every unit
  /// alike, drawn by nobody.
  double curve_stretch = 0.0;
};

/// Throws ConfigError that names the bound, its value and the allowed range.
void validate(const ManufacturingErrors& errors);

/// The curve f(ψ / (1 + stretch)) of a curve f; stretch > −1.
TorqueCurveDescription stretchedCurve(const TorqueCurveDescription& curve, double stretch);

/// One actuator made from the nominal one, with errors drawn from the seed.
Actuator manufacturedActuator(const Actuator& nominal,
                              const ManufacturingErrors& errors,
                              std::uint64_t seed);

}  // namespace sac
