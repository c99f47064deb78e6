#include "support/ceres_costs.hpp"

namespace sac {
namespace {

using Blocks = std::vector<std::pair<Eigen::Index, Eigen::Index>>;

Blocks torqueBlocks(const ParameterSpace& space, const std::vector<Excitation>& excitations) {
  Blocks blocks{{0, space.pole(0)}, {space.pole(0), space.coil(0) - space.pole(0)}};
  for (const Excitation& excitation : excitations) {
    blocks.emplace_back(space.coil(excitation.coil), ParameterSpace::kPerAxis);
  }
  return blocks;
}

}  // namespace

ModelCost::ModelCost(const CalibrationModel& model,
                     const Sample& sample,
                     const Eigen::Matrix3d& whitening,
                     Blocks blocks)
    : model_(model), sample_(sample), whitening_(whitening), blocks_(std::move(blocks)) {
  set_num_residuals(3);
  for (const auto& block : blocks_) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(block.second));
  }
}

bool ModelCost::Evaluate(double const* const* parameters,
                         double* residuals,
                         double** jacobians) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model_.space().size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto [first, size] = blocks_[b];
    x.segment(first, size) = Eigen::Map<const Eigen::VectorXd>(parameters[b], size);
  }
  ResidualJacobian jacobian;
  Eigen::Map<Eigen::Vector3d> whitened(residuals);
  whitened = whitening_ * residual(x, jacobians == nullptr ? nullptr : &jacobian);
  for (std::size_t b = 0; jacobians != nullptr && b < blocks_.size(); ++b) {
    const auto [first, size] = blocks_[b];
    if (jacobians[b] != nullptr) {
      Eigen::Map<ResidualJacobian>(jacobians[b], 3, size) =
          whitening_ * jacobian.middleCols(first, size);
    }
  }
  return true;
}

OrientationCost::OrientationCost(const CalibrationModel& model,
                                 const Sample& sample,
                                 const Eigen::Matrix3d& whitening)
    : ModelCost(model, sample, whitening, {{0, model.space().pole(0)}}) {}

Eigen::Vector3d OrientationCost::residual(const Eigen::VectorXd& x,
                                          ResidualJacobian* jacobian) const {
  return model_.orientationResidual(sample_, x, jacobian);
}

TorqueCost::TorqueCost(const CalibrationModel& model,
                       const Sample& sample,
                       const std::vector<Excitation>& excitations,
                       const Eigen::Matrix3d& whitening)
    : ModelCost(model, sample, whitening, torqueBlocks(model.space(), excitations)),
      excitations_(excitations) {}

Eigen::Vector3d TorqueCost::residual(const Eigen::VectorXd& x, ResidualJacobian* jacobian) const {
  return model_.torqueResidual(sample_, excitations_, x, jacobian);
}

}  // namespace sac
