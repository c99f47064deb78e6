#pragma once

#include <cstdint>
#include <string>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/control/orientation_controller.hpp"
#include "spherical_actuator_calibration/emulation/rotor_friction.hpp"
#include "spherical_actuator_calibration/measurement/motion_plan.hpp"

namespace sac {

/// What stands between a controller and its rotor.
struct RehearsalOptions {
  OrientationControllerOptions controller;
  RigidRotor rotor;  ///< the true one
  BearingFriction friction;
  double joint_rate = 200.0;    ///< of joint angles [Hz]
  double joint_noise = 2e-5;    ///< their standard deviation [rad]
  double current_rate = 200.0;  ///< of setpoints [Hz]
  double time_constant = 2e-3;  ///< of the currents [s]
  std::uint64_t seed = 1;       ///< of the noise
};

/// How a motion went.
struct Rehearsal {
  bool completed = false;               ///< to its end, at rest
  std::string reason;                   ///< why not
  double largest_tilt = 0.0;            ///< of the true joints 1 and 2 [rad]
  double largest_tracking_error = 0.0;  ///< as the controller sees it [rad]
  double largest_coil_current = 0.0;    ///< commanded [A]
  double largest_total_current = 0.0;   ///< commanded [A]
  double largest_square_current = 0.0;  ///< commanded [A²]
  double mean_total_current = 0.0;      ///< Σ|I| of the motion [A]
  double least_excitation_share = 1.0;  ///< that limits and errors left
  double mean_excitation_share = 1.0;   ///< likewise
};

/// Carries out a plan by the controller of this package, which knows `model`, on a rotor that is
/// `truth`: a command for each reading of the joint angles, currents at their own rate. The rotor
/// begins where the plan does. Throws ConfigError when plan, actuators or options are not valid.
Rehearsal rehearse(const MotionPlan& plan,
                   const Actuator& model,
                   const Actuator& truth,
                   const RehearsalOptions& options);

}  // namespace sac
