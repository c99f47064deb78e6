#pragma once

#include <limits>

#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/usual_currents.hpp"
#include "spherical_actuator_calibration/control/computed_torque_control.hpp"
#include "spherical_actuator_calibration/control/current_allocation.hpp"
#include "spherical_actuator_calibration/control/disturbance_observer.hpp"
#include "spherical_actuator_calibration/control/orientation_reference.hpp"

namespace sac {

/// Of OrientationController; validate() says which values are allowed.
struct OrientationControllerOptions {
  RigidRotor rotor;
  ControlGains gains;
  /// During a motion plan, whose excitation disturbs the more the less the parameters are known.
  ControlGains motion_gains = {/*proportional=*/225.0, /*derivative=*/30.0};
  DisturbanceObserverOptions disturbance;
  AllocationOptions allocation;
  OrientationReferenceOptions reference;
  double largest_age = 0.1;        ///< of the joint angles [s]; older ones stop the control
  double velocity_cutoff = 150.0;  ///< of the first-order filter of joint velocities [rad/s]
  double workspace_margin = 0.05;  ///< [rad] joints 1 and 2 may leave the tilt limit so far
  /// Between reference and rotor [rad]; beyond it something holds or pushes the rotor, or a sensor
  /// stands still.
  double largest_tracking_error = 0.4;
  double total_current_limit =
      kUsualTotalCurrent;  ///< of the sum over all coils, as the driver's [A]
  /// ΣI² [A²]: power of the coils per ohm of each.
  double square_current_limit = std::numeric_limits<double>::infinity();
};

/// Throws ConfigError that names the option and its range.
void validate(const OrientationControllerOptions& options);

}  // namespace sac
