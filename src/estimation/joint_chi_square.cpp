#include "spherical_actuator_calibration/estimation/joint_chi_square.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace sac {

double jointChiSquare(const Eigen::MatrixXd& information,
                      const Eigen::VectorXd& gradient,
                      double squared_misfit,
                      const Eigen::MatrixXd& covariance) {
  // P = L Lᵀ, whatever its rank.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(covariance);
  const Eigen::MatrixXd root =
      spectrum.eigenvectors() * spectrum.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  Eigen::MatrixXd inner = root.transpose() * information * root;
  inner.diagonal().array() += 1.0;
  const Eigen::VectorXd projected = root.transpose() * gradient;
  return squared_misfit - projected.dot(inner.llt().solve(projected));
}

}  // namespace sac
