#pragma once

#include <vector>

#include <Eigen/Core>
#include <ceres/cost_function.h>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// W y with y = ln(R_a R(q)ᵀ)^∨: whitened orientation residual over the joint block (9) and, where
/// laboratory effects are modelled, their block. Keeps references: model and sample must outlive
/// it.
class OrientationCost final : public ceres::CostFunction {
 public:
  OrientationCost(const CalibrationModel& model,
                  const Sample& sample,
                  const Eigen::Matrix3d& whitening);

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  const CalibrationModel& model_;
  const Sample& sample_;
  Eigen::Matrix3d whitening_;
};

/// W (T_measured − T_model): whitened torque residual over the joint block (9), the pole block
/// (2m), one block (2) for each excited coil and, where modelled, that of the effects. Keeps
/// references, as above.
class TorqueCost final : public ceres::CostFunction {
 public:
  TorqueCost(const CalibrationModel& model,
             const Sample& sample,
             const std::vector<Excitation>& excitations,
             const Eigen::Matrix3d& whitening);

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  const CalibrationModel& model_;
  const Sample& sample_;
  const std::vector<Excitation>& excitations_;
  Eigen::Matrix3d whitening_;
};

}  // namespace sac
