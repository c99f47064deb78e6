#include "spherical_actuator_calibration/base/cholesky.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kRounding = 1e-13;

/// Symmetric, positive definite.
Eigen::MatrixXd matrixOf(Eigen::Index size) {
  Eigen::MatrixXd root(size, size);
  for (Eigen::Index k = 0; k < root.size(); ++k) {
    root.data()[k] = std::sin(1.0 + 1.7 * static_cast<double>(k));
  }
  return root * root.transpose() + Eigen::MatrixXd::Identity(size, size);
}

TEST(Cholesky, SolvesForOneColumnAndForMany) {
  const Eigen::MatrixXd A = matrixOf(5);
  const Eigen::MatrixXd X = matrixOf(5).leftCols(3);
  const Cholesky factor(A);
  ASSERT_TRUE(factor.isPositive());
  EXPECT_LT((factor.solve(A * X) - X).norm(), kRounding);
  const Eigen::VectorXd x = X.col(1);
  EXPECT_LT((factor.solve(A * x) - x).norm(), kRounding);
  EXPECT_LT((factor.inverse() * A - Eigen::MatrixXd::Identity(5, 5)).norm(), kRounding);
}

TEST(Cholesky, HalvesGiveTheInverse) {
  const Eigen::MatrixXd A = matrixOf(4);
  const Cholesky factor(A);
  EXPECT_LT((factor.lower() * factor.lower().transpose() - A).norm(), kRounding);
  EXPECT_EQ(factor.lower()(0, 3), 0.0);
  const Eigen::MatrixXd half = factor.half(Eigen::MatrixXd::Identity(4, 4));
  EXPECT_LT((half.transpose() * half * A - Eigen::MatrixXd::Identity(4, 4)).norm(), kRounding);
}

TEST(Cholesky, OfThreeRowsIsTheSame) {
  const Eigen::Matrix3d A = matrixOf(3);
  const Cholesky3 factor(A);
  const Cholesky any(A);
  ASSERT_TRUE(factor.isPositive());
  // Stored by rows, as an expression of a transpose is.
  const Eigen::Matrix<double, Eigen::Dynamic, 3> rows = matrixOf(7).leftCols<3>();
  EXPECT_LT((factor.solve(rows.transpose()) - any.solve(rows.transpose())).norm(), kRounding);
  EXPECT_LT((factor.half(rows.transpose()) - any.half(rows.transpose())).norm(), kRounding);
  const Eigen::Vector3d b(1.0, -2.0, 3.0);
  EXPECT_LT((A * factor.solve(b) - b).norm(), kRounding);
  EXPECT_LT((factor.inverse() * A - Eigen::Matrix3d::Identity()).norm(), kRounding);
}

TEST(Cholesky, TellsWhatIsNotPositive) {
  Eigen::MatrixXd A = matrixOf(4);
  A(2, 2) = -1.0;
  EXPECT_FALSE(Cholesky(A).isPositive());
  EXPECT_FALSE(Cholesky3(-Eigen::Matrix3d::Identity()).isPositive());
  EXPECT_FALSE(Cholesky().isPositive());
}

TEST(Cholesky, OfNothingIsNothing) {
  const Cholesky none(Eigen::MatrixXd(0, 0));
  EXPECT_TRUE(none.isPositive());
  EXPECT_EQ(none.inverse().size(), 0);
  EXPECT_EQ(none.solve(Eigen::MatrixXd(0, 3)).cols(), 3);
  EXPECT_EQ(Cholesky(matrixOf(4)).half(Eigen::MatrixXd(4, 0)).cols(), 0);
}

TEST(Cholesky, ARightHandSideMayBeOverwritten) {
  const Eigen::MatrixXd A = matrixOf(4);
  Eigen::VectorXd x = A.col(2);
  x = Cholesky(A).solve(x);
  EXPECT_LT((x - Eigen::VectorXd::Unit(4, 2)).norm(), kRounding);
}

TEST(Cholesky, TheLowerTriangleCounts) {
  const Eigen::MatrixXd A = matrixOf(4);
  Eigen::MatrixXd lower = A;
  lower.triangularView<Eigen::StrictlyUpper>().setConstant(1e3);
  EXPECT_EQ(Cholesky(lower).lower(), Cholesky(A).lower());
}

TEST(SolveSemidefinite, FindsASolutionOfASingularMatrix) {
  Eigen::MatrixXd A = matrixOf(4);
  A.row(1).setZero();
  A.col(1).setZero();
  const Eigen::VectorXd b = A * Eigen::VectorXd::LinSpaced(4, 1.0, 2.0);
  const Eigen::VectorXd x = solveSemidefinite(A, b);
  EXPECT_LT((A * x - b).norm(), kRounding);
  const Eigen::Matrix3d few = A.topLeftCorner<3, 3>();
  const Eigen::Vector3d reached = few * Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_LT((few * solveSemidefinite3(few, reached) - reached).norm(), kRounding);
}

TEST(SemidefiniteRoot, SquaresToTheMatrixOfAnyRank) {
  const Eigen::MatrixXd few = matrixOf(5).leftCols(2);
  for (const Eigen::MatrixXd& A : {matrixOf(5), Eigen::MatrixXd(few * few.transpose())}) {
    const Eigen::MatrixXd root = semidefiniteRoot(A);
    EXPECT_LT((root * root.transpose() - A).norm(), 10.0 * kRounding * A.norm());
  }
}

}  // namespace
}  // namespace sac
