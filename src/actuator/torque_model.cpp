#include "spherical_actuator_calibration/actuator/torque_model.hpp"

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// Torque per ampere of one coil, summed over all poles.
Eigen::Vector3d coilTorque(const TorqueCurve& curve,
                           const TorqueGeometry& geometry,
                           const Eigen::Matrix3d& R_stator_rotor,
                           Eigen::Index coil) {
  const Eigen::Vector3d coil_rotor = R_stator_rotor.transpose() * geometry.coils_stator.col(coil);
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < geometry.poles_rotor.cols(); ++i) {
    if (interacts(curve, geometry.poles_rotor.col(i), coil_rotor)) {
      torque +=
          geometry.pole_strength[i] * pairTorque(curve, geometry.poles_rotor.col(i), coil_rotor);
    }
  }
  return geometry.coil_gain[coil] * torque;
}

}  // namespace

TorqueGeometry torqueGeometry(const Actuator& actuator) {
  TorqueGeometry geometry;
  const auto poles = static_cast<Eigen::Index>(actuator.poles.size());
  const auto coils = static_cast<Eigen::Index>(actuator.coils.size());
  geometry.poles_rotor.resize(3, poles);
  geometry.pole_strength.resize(poles);
  geometry.coils_stator.resize(3, coils);
  geometry.coil_gain.resize(coils);
  for (Eigen::Index i = 0; i < poles; ++i) {
    const PoleAxis& pole = actuator.poles[static_cast<std::size_t>(i)];
    geometry.poles_rotor.col(i) = axisFromAngles(pole.polar, pole.azimuth);
    geometry.pole_strength[i] = pole.polarity * pole.gain;
  }
  for (Eigen::Index j = 0; j < coils; ++j) {
    const CoilAxis& coil = actuator.coils[static_cast<std::size_t>(j)];
    geometry.coils_stator.col(j) = axisFromAngles(coil.polar, coil.azimuth);
    geometry.coil_gain[j] = coil.gain;
  }
  return geometry;
}

Eigen::Vector3d pairTorque(const TorqueCurve& curve,
                           const Eigen::Vector3d& pole_rotor,
                           const Eigen::Vector3d& coil_rotor) {
  const Eigen::Vector3d cross = pole_rotor.cross(coil_rotor);
  return curve.safe(pole_rotor.dot(coil_rotor), cross.norm()).h * cross;
}

PairTorque linearizePairTorque(const TorqueCurve& curve,
                               const Eigen::Vector3d& pole_rotor,
                               const Eigen::Vector3d& coil_rotor) {
  const Eigen::Vector3d cross = pole_rotor.cross(coil_rotor);
  const TorqueCurve::Safe safe = curve.safe(pole_rotor.dot(coil_rotor), cross.norm());
  PairTorque pair;
  pair.torque = safe.h * cross;
  const Eigen::Vector3d slope = safe.dh * cross;
  pair.d_pole = slope * coil_rotor.transpose() - safe.h * skew(coil_rotor);
  pair.d_coil = slope * pole_rotor.transpose() + safe.h * skew(pole_rotor);
  return pair;
}

Eigen::Matrix3Xd torquePerAmpere(const TorqueCurve& curve,
                                 const TorqueGeometry& geometry,
                                 const Eigen::Matrix3d& R_stator_rotor) {
  Eigen::Matrix3Xd Q(3, geometry.coils_stator.cols());
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    Q.col(j) = coilTorque(curve, geometry, R_stator_rotor, j);
  }
  return Q;
}

Eigen::Vector3d rotorTorque(const TorqueCurve& curve,
                            const TorqueGeometry& geometry,
                            const Eigen::Matrix3d& R_stator_rotor,
                            const Eigen::VectorXd& current) {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (Eigen::Index j = 0; j < current.size(); ++j) {
    if (current[j] != 0.0) {
      torque += current[j] * coilTorque(curve, geometry, R_stator_rotor, j);
    }
  }
  return torque;
}

}  // namespace sac
