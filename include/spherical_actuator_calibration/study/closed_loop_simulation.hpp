#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/control/computed_torque_control.hpp"
#include "spherical_actuator_calibration/control/current_allocation.hpp"

namespace sac {

/// A controller that knows `model` on an actuator that is `truth`.
struct ClosedLoopOptions {
  Actuator truth;
  Actuator model;
  RigidRotor rotor;  ///< known to both
  ControlGains gains;
  AllocationOptions allocation;
  double duration = 12.0;  ///< [s]
  double step = 1e-3;      ///< of control and integration [s]
};

/// Desired motion at a time since the begin [s].
using Trajectory = std::function<DesiredMotion(double time)>;

/// The rotor at one time.
struct ClosedLoopPoint {
  double time = 0.0;                                         ///< [s]
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< that the sensors read [rad]
  Eigen::Matrix3d R_stator_rotor = Eigen::Matrix3d::Identity();
  double rotation_error = 0.0;   ///< angle between true and desired orientation [rad]
  double largest_current = 0.0;  ///< of all coils [A]
};

/// How a rotor followed its motion.
struct ClosedLoopResult {
  /// False when the rotor came where the model makes no torque, or out of the joint's range;
  /// `points` end there.
  bool completed = false;
  std::vector<ClosedLoopPoint> points;  ///< one for each step, the begin included
};

/// Simulates the control of the paper's section 4.3.3: the joint sensors read what the true
/// kinematics make of the orientation, the model turns readings into orientation, velocity and
/// torque per ampere, and the true torques move the rotor. It begins at rest relative to the
/// trajectory, where the model sees the desired orientation. Throws ConfigError when the options
/// are not valid.
ClosedLoopResult simulateClosedLoop(const ClosedLoopOptions& options, const Trajectory& trajectory);

}  // namespace sac
