#pragma once

#include <tuple>

#include "coil_gains.hpp"
#include "encoder_harmonics.hpp"
#include "marker_registration.hpp"
#include "motion_delays.hpp"
#include "pole_gains.hpp"
#include "rotor_friction.hpp"
#include "rotor_inertia.hpp"
#include "rotor_unbalance.hpp"
#include "strength_scale.hpp"
#include "tilt_cross_axis.hpp"
#include "torque_bias.hpp"
#include "torque_curve_change.hpp"
#include "torque_registration.hpp"
#include "tracker_registration.hpp"

namespace sac::effects {

/// All laboratory effects, in the order of their coordinates. What another one needs beside its
/// name here: "Add an effect" in doc/architecture.md.
using Registered = std::tuple<TorqueBias,
                              RotorUnbalance,
                              StrengthScale,
                              PoleGains,
                              CoilGains,
                              EncoderHarmonics,
                              TiltCrossAxis,
                              TorqueCurveChange,
                              MarkerRegistration,
                              TrackerRegistration,
                              TorqueRegistration,
                              RotorInertia,
                              ViscousFriction,
                              CoulombFriction,
                              CurrentDelay,
                              CurrentDispersion,
                              TrackerDelay>;

}  // namespace sac::effects
