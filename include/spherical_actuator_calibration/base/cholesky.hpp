#pragma once

#include <Eigen/Core>

namespace sac {

// Compiled once: Eigen's templates for a factor, and for each kind of right-hand side that meets
// it, take seconds in each source that has them.

/// Cholesky factor A = LLᵀ of a symmetric matrix, whose lower triangle counts. `Matrix` is
/// Eigen::Matrix3d or Eigen::MatrixXd.
template <typename Matrix>
class CholeskyFactor {
 public:
  /// Of the compile-time size of `Right`, which may be an expression, stored by columns.
  template <typename Right>
  using Like = Eigen::Matrix<double, Right::RowsAtCompileTime, Right::ColsAtCompileTime>;

  CholeskyFactor() = default;
  explicit CholeskyFactor(const Matrix& A);

  /// False: A is not positive definite, and there is no factor.
  bool isPositive() const { return is_positive_; }
  /// L.
  const Matrix& lower() const { return lower_; }
  Matrix inverse() const;

  /// A⁻¹B, of the shape of B.
  template <typename Right>
  Like<Right> solve(const Eigen::MatrixBase<Right>& B) const {
    Like<Right> result = B;
    eigen_assert(result.rows() == lower_.rows());
    solveInPlace(result.data(), result.cols());
    return result;
  }
  /// L⁻¹B, of the shape of B.
  template <typename Right>
  Like<Right> half(const Eigen::MatrixBase<Right>& B) const {
    Like<Right> result = B;
    eigen_assert(result.rows() == lower_.rows());
    halfInPlace(result.data(), result.cols());
    return result;
  }

 private:
  void solveInPlace(double* columns, Eigen::Index count) const;
  void halfInPlace(double* columns, Eigen::Index count) const;

  Matrix lower_;
  bool is_positive_ = false;
};

extern template class CholeskyFactor<Eigen::Matrix3d>;
extern template class CholeskyFactor<Eigen::MatrixXd>;
using Cholesky3 = CholeskyFactor<Eigen::Matrix3d>;
using Cholesky = CholeskyFactor<Eigen::MatrixXd>;

/// A⁻¹B of a symmetric matrix A, whose lower triangle counts, by pivoted Cholesky decomposition
/// (LDLᵀ): where A is singular, and B is A times something, one of the solutions.
Eigen::MatrixXd solveSemidefinite(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
Eigen::Vector3d solveSemidefinite3(const Eigen::Matrix3d& A, const Eigen::Vector3d& b);

/// R with RRᵀ = A, for a symmetric positive semidefinite A of any rank.
Eigen::MatrixXd semidefiniteRoot(const Eigen::MatrixXd& A);

}  // namespace sac
