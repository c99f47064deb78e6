#pragma once

#include <functional>

#include <Eigen/Core>

namespace sac {

/// Jacobian of f at x by central differences, fourth order; error about 1e-10 for smooth f of
/// size 1. A shorter step is for functions whose derivative has kinks, which it seldom meets.
inline Eigen::MatrixXd numericJacobian(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f,
    const Eigen::VectorXd& x,
    double length = 1e-3) {
  Eigen::MatrixXd jacobian(f(x).size(), x.size());
  for (Eigen::Index c = 0; c < x.size(); ++c) {
    const auto at = [&](double step) {
      Eigen::VectorXd moved = x;
      moved[c] += step;
      return f(moved);
    };
    jacobian.col(c) = (8.0 * (at(length) - at(-length)) - (at(2.0 * length) - at(-2.0 * length))) /
                      (12.0 * length);
  }
  return jacobian;
}

}  // namespace sac
