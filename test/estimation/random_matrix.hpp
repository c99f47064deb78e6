#pragma once

#include <random>

#include <Eigen/Core>

namespace sac {

/// Elements by the standard normal distribution.
inline Eigen::MatrixXd randomMatrix(Eigen::Index rows,
                                    Eigen::Index columns,
                                    std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

}  // namespace sac
