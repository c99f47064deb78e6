#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/estimation/parameter_space.hpp"

namespace sac {

/// All modelled effects together, at the coordinates x. Derivatives are by their E values.
class EffectsAt {
 public:
  /// Keeps a reference to the space.
  EffectsAt(const ParameterSpace& space, const Eigen::VectorXd& x);

  bool empty() const { return values_.size() == 0; }
  const Eigen::VectorXd& values() const { return values_; }

  // 3×E each, see LaboratoryEffect.
  Eigen::Matrix3Xd readingColumns(const Eigen::Vector3d& reading) const;
  Eigen::Matrix3Xd trackerColumns() const;
  Eigen::Matrix3Xd markerColumns() const;
  Eigen::Matrix3Xd torqueFrameColumns() const;
  Eigen::Matrix3Xd loadColumns(const Eigen::Matrix3d& R_rotor_stator) const;
  Eigen::Matrix3d loadRotation(const Eigen::Matrix3d& R_rotor_stator) const;

  /// Factor on the torque of a pair.
  double strength(std::size_t pole, std::size_t coil) const;
  /// Takes ∂T/∂values of that factor off, for a pair that exerts `torque` [N·m].
  void subtractStrengthColumns(std::size_t pole,
                               std::size_t coil,
                               const Eigen::Vector3d& torque,
                               Eigen::Matrix3Xd& columns) const;
  /// The same of other changes of a pair, whose strength times current is `weight` [A].
  void subtractPairColumns(const Eigen::Vector3d& pole_rotor,
                           const Eigen::Vector3d& coil_rotor,
                           double weight,
                           Eigen::Matrix3Xd& columns) const;
  /// The torque curve, where it is not the nominal one.
  std::optional<TorqueCurve> changedCurve() const;

  /// Writes derivatives by values into the columns of the coordinates.
  void write(const Eigen::Matrix3Xd& columns, ResidualJacobian& jacobian) const;

 private:
  template <typename Add>
  Eigen::Matrix3Xd collect(const Add& add) const;

  const ParameterSpace& space_;
  Eigen::VectorXd values_;
};

}  // namespace sac
