#pragma once

#include <functional>

#include <Eigen/Core>

namespace sac {

/// Largest eigenvalue of a symmetric positive matrix of `size` rows that is known by its products
/// with vectors, to some 1e-12 of it, by the method of Lanczos.
double largestEigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& times,
                         Eigen::Index size);

}  // namespace sac
