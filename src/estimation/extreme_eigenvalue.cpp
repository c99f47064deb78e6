#include "extreme_eigenvalue.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace sac {

double largestEigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& times,
                         Eigen::Index size) {
  // The error of the eigenvalue is of second order in that of the vector.
  constexpr double kSettled = 1e-7;
  constexpr Eigen::Index kBetweenLooks = 8;
  Eigen::MatrixXd basis(size, size);
  Eigen::VectorXd diagonal(size);
  Eigen::VectorXd beside(size);
  // Orthogonal to no eigenvector, unless by ill luck.
  Eigen::VectorXd next(size);
  for (Eigen::Index p = 0; p < size; ++p) {
    next[p] = 1.0 + 0.5 * std::sin(static_cast<double>(p * p));
  }
  next.normalize();
  for (Eigen::Index n = 0;; ++n) {
    basis.col(n) = next;
    Eigen::VectorXd product = times(next);
    diagonal[n] = next.dot(product);
    // Twice: rounding would let the directions found before come back.
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd known = basis.leftCols(n + 1).transpose() * product;
      product.noalias() -= basis.leftCols(n + 1) * known;
    }
    beside[n] = product.norm();
    const bool is_last = n + 1 == size || beside[n] == 0.0;
    if (is_last || n % kBetweenLooks == kBetweenLooks - 1) {
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
      eigen.computeFromTridiagonal(diagonal.head(n + 1), beside.head(n));
      const double largest = eigen.eigenvalues()[n];
      if (is_last || beside[n] * std::abs(eigen.eigenvectors()(n, n)) < kSettled * largest) {
        return largest;
      }
    }
    next = product / beside[n];
  }
}

}  // namespace sac
