#pragma once

#include <Eigen/Core>

namespace sac {

/// (L Lᵀ)⁻¹ of a lower triangular L; what is above its diagonal is not looked at. By halves: that
/// the inverse of a triangle is one spares nearly half of the work.
Eigen::MatrixXd inverseOfSquare(const Eigen::MatrixXd& L);

}  // namespace sac
