#pragma once

#include <Eigen/Core>

namespace sac {

/// Squared Mahalanobis norm of residuals r that share uncertain coordinates: rᵀ (I + J P Jᵀ)⁻¹ r
/// for whitened r and J, by Woodbury's identity.
/// @param information JᵀJ, P×P
/// @param gradient Jᵀr
/// @param squared_misfit rᵀr
/// @param covariance P of the coordinates, P×P, positive semidefinite
double jointChiSquare(const Eigen::MatrixXd& information,
                      const Eigen::VectorXd& gradient,
                      double squared_misfit,
                      const Eigen::MatrixXd& covariance);

}  // namespace sac
