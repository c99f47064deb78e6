#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// One coil that carries current during a sample.
struct Excitation {
  std::size_t coil = 0;  ///< counted from 0
  double current = 0.0;  ///< [A]
};

/// Coils of a sample whose measured |current| reaches `threshold` [A]; the others count as off.
std::vector<Excitation> excitedCoils(const Sample& sample, double threshold);

/// Residuals of samples as functions of the coordinates x of a ParameterSpace, with analytic
/// Jacobians, which are written where one is wanted. Many samples at one x are quicker by a
/// ModelPoint.
class CalibrationModel {
 public:
  explicit CalibrationModel(ParameterSpace space);

  const ParameterSpace& space() const { return space_; }
  bool hasTorqueModel() const { return curve_.has_value(); }
  bool hasOrientationMap() const {
    return space_.joints() > 0 && space_.nominal().orientation_map != nullptr;
  }
  /// Precondition: hasTorqueModel().
  const TorqueCurve& curve() const { return *curve_; }

  /// Whether the orientation of a sample is an observation; without joints it is the reading.
  bool observesOrientation(const Sample& sample) const {
    return sample.has_orientation && space_.joints() > 0;
  }

  /// y = ln(R_a R(q)ᵀ)^∨ [rad], stator frame (doc/method.md, Joint (12–14)); ∂y/∂joints = −J_r⁻¹(y)
  /// ∂ξ/∂joints. With effects, q is the corrected reading and R lies between the registrations.
  /// Precondition: the actuator has joints. Without, the measured orientation is the reading.
  Eigen::Vector3d orientationResidual(const Sample& sample,
                                      const Eigen::VectorXd& x,
                                      ResidualJacobian* jacobian = nullptr) const;

  /// T_measured − T_model [N·m], rotor frame (paper (21), doc/method.md, Torque curve).
  /// Precondition: hasTorqueModel().
  Eigen::Vector3d torqueResidual(const Sample& sample,
                                 const std::vector<Excitation>& excitations,
                                 const Eigen::VectorXd& x,
                                 ResidualJacobian* jacobian = nullptr) const;

 private:
  ParameterSpace space_;
  std::optional<TorqueCurve> curve_;
};

}  // namespace sac
