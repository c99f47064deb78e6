#pragma once

#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"

namespace sac {

/// What gravity (along −z of the stator) does to the rotor.
struct RotorLoad {
  double weight = 8.0;  ///< of rotor and load, seen by the force/torque sensor [N]
  /// Weight times the position of the centre of gravity, rotor frame [N·m]: T_g = unbalance ×
  /// Rᵀ(−z) (doc/method.md, Laboratory).
  Eigen::Vector3d unbalance = Eigen::Vector3d::Zero();
};

/// The physics of an emulated actuator: orientation and load of its true parameters.
class TrueActuator {
 public:
  /// Throws ConfigError when the actuator is not valid.
  TrueActuator(const Actuator& truth, const RotorLoad& load);

  bool hasTorque() const { return curve_.has_value(); }

  /// R_stator_rotor when the joint sensors read q [rad].
  Eigen::Matrix3d orientation(const Eigen::Vector3d& q) const;

  /// Weight in the rotor frame [N].
  Eigen::Vector3d weight(const Eigen::Matrix3d& R_stator_rotor) const;

  /// Torque of the coils at the currents [A] and of gravity, about the rotor centre, rotor frame
  /// [N·m]. Precondition: hasTorque().
  Eigen::Vector3d torque(const Eigen::Matrix3d& R_stator_rotor,
                         const Eigen::VectorXd& currents) const;

 private:
  JointGeometry joints_;
  TorqueGeometry torques_;
  std::optional<TorqueCurve> curve_;
  RotorLoad load_;
};

}  // namespace sac
