#include "spherical_actuator_calibration/estimation/joint_chi_square.hpp"

#include <vector>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

double jointChiSquare(const Eigen::MatrixXd& information,
                      const Eigen::VectorXd& gradient,
                      double squared_misfit,
                      const Eigen::MatrixXd& covariance) {
  // Coordinates that no residual depends on have no part in it: of 400 coils few are held out.
  std::vector<Eigen::Index> used;
  for (Eigen::Index p = 0; p < information.rows(); ++p) {
    if (information(p, p) != 0.0) {
      used.push_back(p);
    }
  }
  // P = R Rᵀ, whatever its rank.
  const Eigen::MatrixXd root = semidefiniteRoot(covariance(used, used));
  Eigen::MatrixXd inner = root.transpose() * information(used, used) * root;
  inner.diagonal().array() += 1.0;
  const Eigen::VectorXd projected = root.transpose() * gradient(used);
  return squared_misfit - projected.dot(Cholesky(inner).solve(projected));
}

}  // namespace sac
