#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/emulation/rotor_friction.hpp"

namespace sac {

/// A true actuator whose rotor nothing holds: coils, gravity and friction move it, and
/// whoever pushes it, up to a mechanical stop.
class FreeRotor {
 public:
  /// `stop_tilt` [rad]: joints 1 and 2 turn no further. Throws ConfigError when the actuator has no
  /// torque model, or something is not valid.
  FreeRotor(const Actuator& truth,
            const RigidRotor& rotor,
            double stop_tilt,
            const BearingFriction& friction = {});

  /// Lets go of the rotor, at rest where the joint sensors read q [rad].
  void release(const Eigen::Vector3d& q);

  /// On by `step` ≥ 0 [s] with constant currents [A], and a torque from outside that does not turn
  /// with the rotor (stator frame [N·m]). At the stop the rotor comes to rest.
  void advance(double step,
               const Eigen::VectorXd& currents,
               const Eigen::Vector3d& push_stator = Eigen::Vector3d::Zero());

  const Eigen::Vector3d& position() const { return q_; }  ///< what the joint sensors read [rad]
  const RotorState& state() const { return state_; }
  bool isAtStop() const { return is_at_stop_; }

 private:
  JointGeometry joints_;
  TorqueGeometry torques_;
  TorqueCurve curve_;
  RigidRotor rotor_;
  double stop_tilt_;
  BearingFriction friction_;
  Eigen::Vector3d q_ = Eigen::Vector3d::Zero();
  RotorState state_;
  bool is_at_stop_ = false;
};

}  // namespace sac
