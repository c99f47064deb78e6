#include "spherical_actuator_calibration/base/cholesky.hpp"

#include <Eigen/Cholesky>

namespace sac {
namespace {

/// Calls `solve` for a right-hand side that lies column by column: one by one where there are three
/// rows, which Eigen unrolls.
template <typename Matrix, typename Solve>
void forColumns(const Matrix& lower, double* columns, Eigen::Index count, Solve solve) {
  using Vector = Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1>;
  const Eigen::Index rows = lower.rows();
  if constexpr (Matrix::RowsAtCompileTime == Eigen::Dynamic) {
    if (count > 1) {
      solve(Eigen::Map<Eigen::MatrixXd>(columns, rows, count));
      return;
    }
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    solve(Eigen::Map<Vector>(columns + k * rows, rows));
  }
}

}  // namespace

template <typename Matrix>
CholeskyFactor<Matrix>::CholeskyFactor(const Matrix& A) {
  const Eigen::LLT<Matrix> factor(A);
  lower_ = factor.matrixL();
  is_positive_ = factor.info() == Eigen::Success;
}

template <typename Matrix>
Matrix CholeskyFactor<Matrix>::inverse() const {
  return solve(Matrix::Identity(lower_.rows(), lower_.cols()));
}

template <typename Matrix>
void CholeskyFactor<Matrix>::solveInPlace(double* columns, Eigen::Index count) const {
  forColumns(lower_, columns, count, [this](auto right) {
    lower_.template triangularView<Eigen::Lower>().solveInPlace(right);
    lower_.transpose().template triangularView<Eigen::Upper>().solveInPlace(right);
  });
}

template <typename Matrix>
void CholeskyFactor<Matrix>::halfInPlace(double* columns, Eigen::Index count) const {
  forColumns(lower_, columns, count, [this](auto right) {
    lower_.template triangularView<Eigen::Lower>().solveInPlace(right);
  });
}

template class CholeskyFactor<Eigen::Matrix3d>;
template class CholeskyFactor<Eigen::MatrixXd>;

Eigen::MatrixXd solveSemidefinite(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

Eigen::Vector3d solveSemidefinite3(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  return A.ldlt().solve(b);
}

Eigen::MatrixXd semidefiniteRoot(const Eigen::MatrixXd& A) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(A);
  const Eigen::MatrixXd lower = factor.matrixL();
  const Eigen::VectorXd scale = factor.vectorD().cwiseMax(0.0).cwiseSqrt();
  return factor.transpositionsP().transpose() * (lower * scale.asDiagonal());
}

}  // namespace sac
