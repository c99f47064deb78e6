#pragma once

#include <vector>

#include <Eigen/Core>

namespace sac {

/// Coordinates that take part in directions (P×d, orthonormal columns): more than 1 % of their unit
/// vector lies there, squared. Ascending.
std::vector<Eigen::Index> coordinatesOf(const Eigen::MatrixXd& directions);

}  // namespace sac
