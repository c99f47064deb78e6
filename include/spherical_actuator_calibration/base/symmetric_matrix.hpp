#pragma once

#include <Eigen/Core>

namespace sac {

// Compiled once: Eigen's templates for matrices of any size take seconds in each source that has
// them.

/// A symmetric matrix as vectors · diag(values) · vectorsᵀ.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< orthonormal columns, in the order of the values
};

/// Of a matrix whose lower triangle counts.
SymmetricEigen symmetricEigen(const Eigen::MatrixXd& matrix);

/// The values alone, for a small part of the time.
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace sac
