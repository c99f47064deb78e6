#include "normal_equations.hpp"

namespace sac {
namespace {

/// Adds one observation; `slot` maps a coordinate to its place among the chosen ones, or −1.
void accumulate(const LinearizedObservation& linear,
                const Eigen::Matrix3d& weight,
                const Eigen::Matrix3d& noise,
                const std::vector<Eigen::Index>& slot,
                NormalEquations& normal) {
  for (const Eigen::Index a : linear.columns) {
    const Eigen::Index row = slot[static_cast<std::size_t>(a)];
    if (row < 0) {
      continue;
    }
    const Eigen::Vector3d weighted = weight * linear.jacobian.col(a);
    const Eigen::Vector3d noisy = noise * weighted;
    for (const Eigen::Index b : linear.columns) {
      const Eigen::Index column = slot[static_cast<std::size_t>(b)];
      if (column < 0) {
        normal.others(row, b) += weighted.dot(linear.jacobian.col(b));
        continue;
      }
      normal.information(row, column) += weighted.dot(linear.jacobian.col(b));
      normal.noise(row, column) += noisy.dot(weight * linear.jacobian.col(b));
    }
  }
}

}  // namespace

NormalEquations accumulateNormalEquations(const NormalEquationsInput& input,
                                          const Eigen::VectorXd& x,
                                          const std::vector<Eigen::Index>& coordinates) {
  const auto count = static_cast<Eigen::Index>(coordinates.size());
  std::vector<Eigen::Index> slot(static_cast<std::size_t>(x.size()), -1);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    slot[static_cast<std::size_t>(coordinates[k])] = static_cast<Eigen::Index>(k);
  }
  NormalEquations normal;
  normal.information = Eigen::MatrixXd::Zero(count, count);
  normal.noise = Eigen::MatrixXd::Zero(count, count);
  normal.others = Eigen::MatrixXd::Zero(count, x.size());
  LinearizedObservation linear;
  for (std::size_t n = 0; n < input.active.size(); ++n) {
    if (!input.active[n]) {
      continue;
    }
    input.evaluator->linearize(n, x, linear);
    const Eigen::Matrix3d weight = (*input.whitening)[n].transpose() * (*input.whitening)[n];
    accumulate(linear, weight, input.evaluator->noise(n, linear), slot, normal);
  }
  return normal;
}

}  // namespace sac
