#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>
#include <ceres/cost_function.h>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// A whitened residual of the model as Ceres takes it: over blocks of the coordinates. All others
/// are zero. Keeps references: model and sample must outlive it.
class ModelCost : public ceres::CostFunction {
 public:
  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override;

 protected:
  /// `blocks`: first coordinate and number of each.
  ModelCost(const CalibrationModel& model,
            const Sample& sample,
            const Eigen::Matrix3d& whitening,
            std::vector<std::pair<Eigen::Index, Eigen::Index>> blocks);

  virtual Eigen::Vector3d residual(const Eigen::VectorXd& x, ResidualJacobian* jacobian) const = 0;

  const CalibrationModel& model_;
  const Sample& sample_;

 private:
  Eigen::Matrix3d whitening_;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> blocks_;
};

/// W y with y = ln(R_a R(q)ᵀ)^∨ over the joint block (9).
class OrientationCost final : public ModelCost {
 public:
  OrientationCost(const CalibrationModel& model,
                  const Sample& sample,
                  const Eigen::Matrix3d& whitening);

 private:
  Eigen::Vector3d residual(const Eigen::VectorXd& x, ResidualJacobian* jacobian) const override;
};

/// W (T_measured − T_model) over the joint block (9), the pole block (2m) and one block (2) for
/// each excited coil. Keeps a reference to the excitations, too.
class TorqueCost final : public ModelCost {
 public:
  TorqueCost(const CalibrationModel& model,
             const Sample& sample,
             const std::vector<Excitation>& excitations,
             const Eigen::Matrix3d& whitening);

 private:
  Eigen::Vector3d residual(const Eigen::VectorXd& x, ResidualJacobian* jacobian) const override;

  const std::vector<Excitation>& excitations_;
};

}  // namespace sac
