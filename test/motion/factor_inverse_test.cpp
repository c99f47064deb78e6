#include "factor_inverse.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(FactorInverse, TimesTheSquareIsOne) {
  for (const Eigen::Index size : {1, 2, 3, 8, 87}) {
    Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index row = 0; row < size; ++row) {
      for (Eigen::Index column = 0; column < row; ++column) {
        factor(row, column) = std::sin(static_cast<double>(7 * row + 3 * column));
      }
      factor(row, row) = 3.0 + std::cos(static_cast<double>(row));
    }
    const Eigen::MatrixXd square = factor * factor.transpose();
    factor.triangularView<Eigen::StrictlyUpper>().setConstant(1e9);
    const Eigen::MatrixXd inverse = inverseOfSquare(factor);
    EXPECT_EQ(inverse, Eigen::MatrixXd(inverse.transpose()));
    const Eigen::MatrixXd expected = square.llt().solve(Eigen::MatrixXd::Identity(size, size));
    EXPECT_LT((inverse - expected).norm(), 1e-12 * expected.norm()) << size;
  }
}

}  // namespace
}  // namespace sac
