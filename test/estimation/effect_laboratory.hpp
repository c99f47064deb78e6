#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/estimation/laboratory_effects.hpp"
#include "support/scenarios.hpp"

namespace sac {

inline constexpr double kOrientationNoise = 1e-3;
inline constexpr double kTorqueNoise = 5e-4;

/// These effects and no other.
inline EffectSelection only(const std::vector<std::string>& effects) {
  EffectSelection selection;
  for (const std::string& effect : effects) {
    selection[effect] = true;
  }
  return selection;
}

/// A laboratory by its physics, independent of the model that is tested.
struct Laboratory {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d unbalance = Eigen::Vector3d::Zero();
  Eigen::Vector4d harmonics = Eigen::Vector4d::Zero();
  Eigen::Matrix2d tilt = Eigen::Matrix2d::Zero();
  Eigen::Vector3d marker = Eigen::Vector3d::Zero();  ///< rotation of the marker on the rotor

  /// Joint angles when the sensors read q.
  Eigen::Vector3d angles(const Eigen::Vector3d& q) const {
    Eigen::Vector3d result = q;
    result.head<2>() += tilt * q.head<2>();
    result[2] += harmonics[0] * std::cos(q[2]) + harmonics[1] * std::sin(q[2]) +
                 harmonics[2] * std::cos(2.0 * q[2]) + harmonics[3] * std::sin(2.0 * q[2]);
    return result;
  }
};

/// Measures the samples of the paper's session again, in a laboratory with effects, with the
/// tracker on everywhere.
inline std::vector<Sample> sessionIn(const Laboratory& laboratory,
                                     const Actuator& truth,
                                     scenarios::Generator& generator) {
  std::vector<Sample> samples =
      scenarios::paperSession(truth, scenarios::Tracker::kEveryPose, generator);
  const JointGeometry joints = jointGeometry(truth.joints);
  const TorqueGeometry geometry = torqueGeometry(truth);
  const TorqueCurve curve(*truth.torque_curve);
  for (Sample& sample : samples) {
    const Eigen::Matrix3d R = rotorOrientation(joints, laboratory.angles(sample.joint_position));
    sample.R_stator_rotor = rotationExp(scenarios::uniformNoise(kOrientationNoise, generator)) * R *
                            rotationExp(laboratory.marker);
    if (sample.has_torque) {
      const Eigen::Vector3d gravity = R.transpose() * Eigen::Vector3d(0.0, 0.0, -1.0);
      sample.torque = rotorTorque(curve, geometry, R, sample.current) + laboratory.bias +
                      laboratory.unbalance.cross(gravity) +
                      scenarios::uniformNoise(kTorqueNoise, generator);
    }
  }
  return samples;
}

/// The paper's actuator with manufacturing errors.
inline Actuator madeUnit(scenarios::Generator& generator) {
  return scenarios::perturbed(scenarios::paperNominal(), 0.03, 0.02, generator);
}

}  // namespace sac
