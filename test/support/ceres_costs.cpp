#include "support/ceres_costs.hpp"

#include <cstdint>

#include <boost/container/small_vector.hpp>

namespace sac {
namespace {

using RowMajorJacobian = Eigen::Map<Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>>;

/// Block that Ceres wants (null pointer: not wanted), packed: stride equals width.
JacobianBlock packed(double** jacobians, std::size_t block, Eigen::Index width) {
  return {jacobians == nullptr ? nullptr : jacobians[block], width};
}

void whiten(const Eigen::Matrix3d& whitening, const JacobianBlock& block) {
  if (block.data != nullptr) {
    RowMajorJacobian jacobian(block.data, 3, block.stride);
    for (Eigen::Index column = 0; column < block.stride; ++column) {
      jacobian.col(column) = (whitening * jacobian.col(column)).eval();
    }
  }
}

std::int32_t effectCount(const CalibrationModel& model) {
  return static_cast<std::int32_t>(model.space().effects().size());
}

}  // namespace

OrientationCost::OrientationCost(const CalibrationModel& model,
                                 const Sample& sample,
                                 const Eigen::Matrix3d& whitening)
    : model_(model), sample_(sample), whitening_(whitening) {
  set_num_residuals(3);
  mutable_parameter_block_sizes()->push_back(9);
  if (effectCount(model) > 0) {
    mutable_parameter_block_sizes()->push_back(effectCount(model));
  }
}

bool OrientationCost::Evaluate(double const* const* parameters,
                               double* residuals,
                               double** jacobians) const {
  CalibrationModel::OrientationBlocks blocks;
  blocks.joints = parameters[0];
  blocks.d_joints = packed(jacobians, 0, 9);
  if (effectCount(model_) > 0) {
    blocks.effects = parameters[1];
    blocks.d_effects = packed(jacobians, 1, effectCount(model_));
  }
  Eigen::Map<Eigen::Vector3d> whitened(residuals);
  whitened = whitening_ * model_.orientationResidual(sample_, blocks);
  whiten(whitening_, blocks.d_joints);
  whiten(whitening_, blocks.d_effects);
  return true;
}

TorqueCost::TorqueCost(const CalibrationModel& model,
                       const Sample& sample,
                       const std::vector<Excitation>& excitations,
                       const Eigen::Matrix3d& whitening)
    : model_(model), sample_(sample), excitations_(excitations), whitening_(whitening) {
  set_num_residuals(3);
  mutable_parameter_block_sizes()->push_back(9);
  mutable_parameter_block_sizes()->push_back(static_cast<std::int32_t>(2 * model.space().poles()));
  for (std::size_t e = 0; e < excitations.size(); ++e) {
    mutable_parameter_block_sizes()->push_back(2);
  }
  if (effectCount(model) > 0) {
    mutable_parameter_block_sizes()->push_back(effectCount(model));
  }
}

bool TorqueCost::Evaluate(double const* const* parameters,
                          double* residuals,
                          double** jacobians) const {
  constexpr std::size_t kFirstCoil = 2;
  boost::container::small_vector<JacobianBlock, 8> d_coils;
  for (std::size_t e = 0; e < excitations_.size(); ++e) {
    d_coils.push_back(packed(jacobians, kFirstCoil + e, 2));
  }
  CalibrationModel::TorqueBlocks blocks;
  blocks.joints = parameters[0];
  blocks.poles = parameters[1];
  blocks.coils = parameters + kFirstCoil;
  blocks.d_joints = packed(jacobians, 0, 9);
  blocks.d_poles = packed(jacobians, 1, static_cast<Eigen::Index>(2 * model_.space().poles()));
  blocks.d_coils = jacobians == nullptr ? nullptr : d_coils.data();
  if (effectCount(model_) > 0) {
    const std::size_t last = kFirstCoil + excitations_.size();
    blocks.effects = parameters[last];
    blocks.d_effects = packed(jacobians, last, effectCount(model_));
  }
  Eigen::Map<Eigen::Vector3d> whitened(residuals);
  whitened = whitening_ * model_.torqueResidual(sample_, excitations_, blocks);
  whiten(whitening_, blocks.d_joints);
  whiten(whitening_, blocks.d_poles);
  whiten(whitening_, blocks.d_effects);
  for (const JacobianBlock& block : d_coils) {
    whiten(whitening_, block);
  }
  return true;
}

}  // namespace sac
