#pragma once

#include <Eigen/Core>

namespace sac {

/// Moore–Penrose inverse, of a matrix of any shape and rank. Compiled once: Eigen's templates for
/// it take seconds in each source that has them.
Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& matrix);

}  // namespace sac
