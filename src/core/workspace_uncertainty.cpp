#include "spherical_actuator_calibration/core/workspace_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "spherical_actuator_calibration/core/spherical_joint.hpp"

namespace spherical_actuator_calibration {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Element `index` ≥ 1 of the van der Corput sequence in [0, 1).
double vanDerCorput(int index, int base) {
  double value = 0.0;
  double digit = 1.0 / base;
  for (int rest = index; rest > 0; rest /= base) {
    value += digit * (rest % base);
    digit /= base;
  }
  return value;
}

double percentile95(std::vector<double>& values) {
  if (values.empty()) {
    return 0.0;
  }
  const std::ptrdiff_t rank = std::lround(0.95 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// √tr(J Σ Jᵀ) with J given by two column ranges of the coordinates, joined in `columns`.
double expectedError(const Eigen::Matrix3Xd& J,
                     const std::vector<Eigen::Index>& columns,
                     const Eigen::MatrixXd& covariance) {
  double trace = 0.0;
  for (Eigen::Index a = 0; a < J.cols(); ++a) {
    for (Eigen::Index b = 0; b < J.cols(); ++b) {
      trace += J.col(a).dot(J.col(b)) * covariance(columns[static_cast<std::size_t>(a)],
                                                   columns[static_cast<std::size_t>(b)]);
    }
  }
  return std::sqrt(std::max(0.0, trace));
}

/// ∂T/∂coordinates [N·m/(A·rad)] of one coil at unit current, for joints, poles and that coil.
double torqueError(const CalibrationModel& model,
                   const ParameterBelief& belief,
                   const Sample& pose,
                   std::size_t coil) {
  const ParameterSpace& space = model.space();
  const Eigen::Index common = space.coil(0);
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> J(3, common + 2);
  J.setZero();
  const double* coil_block = belief.x.data() + space.coil(coil);
  const JacobianBlock d_coil{J.data() + common, J.cols()};
  CalibrationModel::TorqueBlocks blocks;
  blocks.joints = belief.x.data();
  blocks.poles = belief.x.data() + space.pole(0);
  blocks.coils = &coil_block;
  blocks.d_joints = {J.data(), J.cols()};
  blocks.d_poles = {J.data() + space.pole(0), J.cols()};
  blocks.d_coils = &d_coil;
  model.torqueResidual(pose, {{coil, 1.0}}, blocks);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index c = 0; c < common; ++c) {
    columns.push_back(c);
  }
  columns.push_back(space.coil(coil));
  columns.push_back(space.coil(coil) + 1);
  return expectedError(J, columns, belief.covariance);
}

}  // namespace

WorkspaceUncertainty workspaceUncertainty(const CalibrationModel& model,
                                          const ParameterBelief& belief,
                                          int poses) {
  const ParameterSpace& space = model.space();
  const double tilt = space.nominal().workspace.tilt_limit;
  const JointGeometry joints = jointGeometry(space.actuatorAt(belief.x).joints);
  std::vector<double> orientation_errors;
  std::vector<double> torque_errors;
  Eigen::Matrix<double, 3, 9, Eigen::RowMajor> J;
  const std::vector<Eigen::Index> joint_columns{0, 1, 2, 3, 4, 5, 6, 7, 8};
  for (int n = 1; n <= poses; ++n) {
    Sample pose;
    pose.joint_position << tilt * (2.0 * vanDerCorput(n, 2) - 1.0),
        tilt * (2.0 * vanDerCorput(n, 3) - 1.0), kPi * (2.0 * vanDerCorput(n, 5) - 1.0);
    // Measured where the model puts it, so that the residual's Jacobian is minus the orientation's.
    pose.R_stator_rotor = rotorOrientation(joints, pose.joint_position);
    model.orientationResidual(pose, belief.x.data(), {J.data(), 9});
    orientation_errors.push_back(expectedError(J, joint_columns, belief.covariance));
    for (std::size_t j = 0; model.hasTorqueModel() && j < space.coils(); ++j) {
      torque_errors.push_back(torqueError(model, belief, pose, j));
    }
  }
  return {percentile95(orientation_errors), percentile95(torque_errors)};
}

}  // namespace spherical_actuator_calibration
