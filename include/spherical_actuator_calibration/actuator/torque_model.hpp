#pragma once

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

namespace sac {

/// Pole and coil axes in the form that the torque model needs.
struct TorqueGeometry {
  Eigen::Matrix3Xd poles_rotor;   ///< unit pole axes r_i, rotor frame
  Eigen::VectorXd pole_strength;  ///< p_i times gain, dimensionless
  Eigen::Matrix3Xd coils_stator;  ///< unit coil axes s⁰_j, stator frame
  Eigen::VectorXd coil_gain;      ///< dimensionless
};

/// Geometry of a description's poles and coils.
TorqueGeometry torqueGeometry(const Actuator& actuator);

/// Torque of one pole–coil pair per ampere and unit strength, and its derivatives, rotor frame
/// (doc/method.md, Torque): τ = h(κ) (r×s), κ = r·s.
struct PairTorque {
  Eigen::Vector3d torque;  ///< [N·m/A]
  Eigen::Matrix3d d_pole;  ///< ∂τ/∂r = −h ŝ + h′ (r×s) sᵀ
  Eigen::Matrix3d d_coil;  ///< ∂τ/∂s = h r̂ + h′ (r×s) rᵀ
};

/// True when the pair can exert torque; outside the curve's support every part of it is zero.
inline bool interacts(const TorqueCurve& curve,
                      const Eigen::Vector3d& pole_rotor,
                      const Eigen::Vector3d& coil_rotor) {
  return pole_rotor.dot(coil_rotor) > curve.cosSupportEnd();
}

/// Torque [N·m/A] of one pair; both axes unit, in the rotor frame.
Eigen::Vector3d pairTorque(const TorqueCurve& curve,
                           const Eigen::Vector3d& pole_rotor,
                           const Eigen::Vector3d& coil_rotor);

/// The same with its derivatives.
PairTorque linearizePairTorque(const TorqueCurve& curve,
                               const Eigen::Vector3d& pole_rotor,
                               const Eigen::Vector3d& coil_rotor);

/// Torque per ampere of every coil at one orientation: the 3×l matrix Q with T = Q I, rotor frame
/// [N·m/A] (paper (21–22)).
Eigen::Matrix3Xd torquePerAmpere(const TorqueCurve& curve,
                                 const TorqueGeometry& geometry,
                                 const Eigen::Matrix3d& R_stator_rotor);

/// Torque on the rotor, rotor frame [N·m], for coil currents [A] (paper (21)). Coils without
/// current cost nothing.
Eigen::Vector3d rotorTorque(const TorqueCurve& curve,
                            const TorqueGeometry& geometry,
                            const Eigen::Matrix3d& R_stator_rotor,
                            const Eigen::VectorXd& current);

}  // namespace sac
