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

/// All laboratory effects, in the order of their coordinates. To add one:
///   1. write effects/<name>.hpp beside this file: a class like its neighbours, with kName, kUnit,
///      kActsOn, kBelongsTo, a constructor (nominal, selection), and an override for each thing it
///      acts on;
///   2. name the class here;
///   3. say what it is in config/calibration.yaml and doc/method.md, Laboratory;
///   4. let test/estimation/laboratory_effects_test.cpp find it in simulated samples.
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
