#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

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

/// Where a residual function writes a block of its Jacobian: 3 rows, row-major, `stride` doubles
/// from row to row. Not wanted when `data` is null.
struct JacobianBlock {
  double* data = nullptr;
  Eigen::Index stride = 0;
};

/// Residuals of samples as functions of the coordinates of a ParameterSpace, with analytic
/// Jacobians. The coordinates come as pointers to the blocks (joints: 9, poles: 2m, one coil: 2,
/// laboratory effects: as many as are modelled), because that is how a solver holds them; a whole
/// coordinate vector is such a set of blocks, too. `effects` is not read when none is modelled.
class CalibrationModel {
 public:
  explicit CalibrationModel(ParameterSpace space);

  const ParameterSpace& space() const { return space_; }
  bool hasTorqueModel() const { return curve_.has_value(); }
  /// Precondition: hasTorqueModel().
  const TorqueCurve& curve() const { return *curve_; }

  /// Blocks that an orientation residual depends on.
  struct OrientationBlocks {
    const double* joints = nullptr;
    const double* effects = nullptr;
    JacobianBlock d_joints;
    JacobianBlock d_effects;
  };

  /// y = ln(R_a R(q)ᵀ)^∨ [rad], stator frame (doc/method.md, Joint (12–14)); ∂y/∂joints = −J_r⁻¹(y)
  /// ∂ξ/∂joints. With effects, q is the corrected reading and R lies between the registrations.
  Eigen::Vector3d orientationResidual(const Sample& sample, const OrientationBlocks& blocks) const;

  /// Blocks that a torque residual depends on; `coils` and `d_coils` go along with its excitations.
  struct TorqueBlocks {
    const double* joints = nullptr;
    const double* poles = nullptr;
    const double* const* coils = nullptr;
    const double* effects = nullptr;
    JacobianBlock d_joints;
    JacobianBlock d_poles;
    const JacobianBlock* d_coils = nullptr;  ///< null when none is wanted
    JacobianBlock d_effects;
  };

  /// T_measured − T_model [N·m], rotor frame (paper (21), doc/method.md, Torque curve).
  /// Precondition: hasTorqueModel().
  Eigen::Vector3d torqueResidual(const Sample& sample,
                                 const std::vector<Excitation>& excitations,
                                 const TorqueBlocks& blocks) const;

 private:
  TorqueCurve curveAt(const double* effects) const;

  ParameterSpace space_;
  std::optional<TorqueCurve> curve_;
  std::vector<TorqueCurve> curve_basis_;  ///< of the modelled coefficients, one each
};

}  // namespace sac
