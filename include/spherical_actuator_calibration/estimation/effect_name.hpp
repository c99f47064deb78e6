#pragma once

/// Names of the laboratory effects: of `effects/model`, of their parameters ("rotor_inertia/xx"),
/// and wherever one is told apart from the others.
namespace sac::effect_name {

inline constexpr auto kTorqueBias = "torque_bias";
inline constexpr auto kRotorUnbalance = "rotor_unbalance";
inline constexpr auto kStrengthScale = "strength_scale";
inline constexpr auto kPoleGains = "pole_gains";
inline constexpr auto kCoilGains = "coil_gains";
inline constexpr auto kEncoderHarmonics = "encoder_harmonics";
inline constexpr auto kTiltCrossAxis = "tilt_cross_axis";
inline constexpr auto kTorqueCurve = "torque_curve";
inline constexpr auto kMarkerRegistration = "marker_registration";
inline constexpr auto kTrackerRegistration = "tracker_registration";
inline constexpr auto kTorqueRegistration = "torque_registration";
inline constexpr auto kRotorInertia = "rotor_inertia";
inline constexpr auto kViscousFriction = "viscous_friction";
inline constexpr auto kCoulombFriction = "coulomb_friction";
inline constexpr auto kCurrentDelay = "current_delay";
inline constexpr auto kCurrentDispersion = "current_dispersion";
inline constexpr auto kTrackerDelay = "tracker_delay";

}  // namespace sac::effect_name
