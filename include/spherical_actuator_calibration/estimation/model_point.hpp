#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"

namespace sac {

/// A model at one point x of its coordinates: what depends on them alone (joint axes, poles and
/// coils with their derivatives, effects, the torque curve) is worked out once for all samples.
class ModelPoint {
 public:
  /// Keeps a reference to the model.
  ModelPoint(const CalibrationModel& model, const Eigen::VectorXd& x);

  /// See CalibrationModel::orientationResidual().
  Eigen::Vector3d orientationResidual(const Sample& sample,
                                      ResidualJacobian* jacobian = nullptr) const;
  /// See CalibrationModel::torqueResidual(), with its precondition.
  Eigen::Vector3d torqueResidual(const Sample& sample,
                                 const std::vector<Excitation>& excitations,
                                 ResidualJacobian* jacobian = nullptr) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace sac
